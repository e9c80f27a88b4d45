#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace loopgrid::test_support {

/// The path of a shared recording (`logs/intel.clf`), if the environment variable LOOPGRID_DATA
/// names the folder that has it.
inline std::optional<std::string> Recording(const std::string& name) {
  const char* folder = std::getenv("LOOPGRID_DATA");
  if (folder == nullptr) return std::nullopt;
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path.string();
}

/// A file that comes with Debian's mrpt-common.
inline std::string MrptDataset(const std::string& name) {
  return "/usr/share/mrpt/datasets/" + name;
}

}  // namespace loopgrid::test_support

/// Skips the test where the recording is missing; `path` is then declared and names it.
#define LOOPGRID_REQUIRE_RECORDING(path, name)                                        \
  const auto found_##path = ::loopgrid::test_support::Recording(name);                \
  if (!found_##path) GTEST_SKIP() << "LOOPGRID_DATA names no folder with " << (name); \
  const std::string& path = *found_##path
