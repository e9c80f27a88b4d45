#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "backend/files/graph_file.h"
#include "tests/support/manhattan_world.h"

namespace loopgrid::test_support {

using AnyGraph = std::variant<PoseGraph<SE2>, PoseGraph<SE3>>;

/// The graphs for benchmarks of the back-end: a generated city, and the public benchmark graphs in
/// the folder graphs/ of LOOPGRID_DATA, if it is set.
inline std::vector<std::string> BenchmarkGraphNames() {
  std::vector<std::string> names = {"city1700"};
  const char* folder = std::getenv("LOOPGRID_DATA");
  if (folder == nullptr) return names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(folder) / "graphs")) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin() + 1, names.end());
  return names;
}

/// One of those graphs; `city` with a number is a generated city with that number of nodes.
inline AnyGraph BenchmarkGraph(const std::string& name) {
  if (name.starts_with("city") && name.find('.') == std::string::npos) {
    return ManhattanWorld(std::stoi(name.substr(4)), 4, 1);
  }
  const char* folder = std::getenv("LOOPGRID_DATA");
  const auto path = std::filesystem::path(folder == nullptr ? "" : folder) / "graphs" / name;
  return std::visit([](const auto& file) -> AnyGraph { return file.graph; },
                    ReadGraph(path.string()));
}

}  // namespace loopgrid::test_support
