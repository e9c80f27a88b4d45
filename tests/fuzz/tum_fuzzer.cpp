// Any bytes as a TUM trajectory: an Error, or valid poses.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "backend/base/error.h"
#include "frontend/evaluation/tum_file.h"
#include "tests/support/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const loopgrid::test_support::MemoryFile file({reinterpret_cast<const char*>(data), size});
  try {
    for (const auto& [timestamp, pose] : loopgrid::ReadTumFile(file.path())) {
      if (!std::isfinite(timestamp) || !pose.coordinates().allFinite()) std::abort();
    }
  } catch (const loopgrid::Error& error) {
    if (std::string_view(error.what()).find(file.path() + ":") != 0) std::abort();
  }
  return 0;
}
