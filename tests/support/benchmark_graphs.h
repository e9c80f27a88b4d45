#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "backend/graph_file.h"
#include "tests/support/manhattan_world.h"

namespace loopgrid::test_support {

struct NamedGraph {
  std::string name;
  PoseGraph<SE2> graph;
};

/// What benchmarks of the back-end run on: a generated city and, where LOOPGRID_DATA names the
/// folder that has them in graphs/, public benchmark graphs.
inline std::vector<NamedGraph> BenchmarkGraphs() {
  std::vector<NamedGraph> graphs = {{"city1700", ManhattanWorld(1700, 4, 1)}};
  const char* folder = std::getenv("LOOPGRID_DATA");
  if (folder == nullptr) return graphs;
  for (const char* name : {"intel", "intel-943", "manhattan3500", "city10000"}) {
    const auto path = std::filesystem::path(folder) / "graphs" / (std::string(name) + ".g2o");
    graphs.push_back({name, ReadGraphOf<SE2>(path.string()).graph});
  }
  return graphs;
}

}  // namespace loopgrid::test_support
