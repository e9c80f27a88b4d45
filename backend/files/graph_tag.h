#pragma once

#include <string_view>

#include "backend/files/graph_builder.h"
#include "backend/files/graph_line.h"

namespace loopgrid {

/// A kind of line of a graph file.
template <typename Pose>
struct GraphTag {
  std::string_view name;
  const char* fields;  ///< that follow, as messages show them
  void (*read)(GraphLine* line, GraphBuilder<Pose>* builder);
};

}  // namespace loopgrid
