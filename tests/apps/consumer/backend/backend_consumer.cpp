#include <cstdio>

#include "backend/files/graph_file.h"
#include "backend/graph/pose_graph.h"

int main(int, char** argv) {
  const auto file = loopgrid::ReadGraphOf<loopgrid::SE2>(argv[1]);
  std::printf("%zu nodes, %zu constraints\n", file.graph.poses.size(),
              file.graph.constraints.size());
}
