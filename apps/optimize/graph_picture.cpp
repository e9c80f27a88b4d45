#include "apps/optimize/graph_picture.h"

namespace loopgrid {
namespace {

Eigen::Vector3d InSpace(const Eigen::Vector2d& p) { return {p.x(), p.y(), 0.0}; }
Eigen::Vector3d InSpace(const Eigen::Vector3d& p) { return p; }

}  // namespace

template <typename Pose>
GraphState StateOf(const PoseGraph<Pose>& graph, const std::string& title) {
  GraphState state;
  state.title = title;
  state.nodes.reserve(graph.poses.size());
  for (const Pose& pose : graph.poses) state.nodes.push_back(InSpace(pose.translation()));
  for (const auto& landmark : graph.landmarks) state.landmarks.push_back(InSpace(landmark));
  return state;
}

template <typename Pose>
std::vector<GraphEdge> EdgesOf(const PoseGraph<Pose>& graph, const IdOrder& order) {
  std::vector<GraphEdge> edges;
  edges.reserve(graph.constraints.size());
  for (const Constraint<Pose>& constraint : graph.constraints) {
    const bool is_sequential = order.AreConsecutive(constraint.from, constraint.to);
    edges.push_back({constraint.from, constraint.to,
                     is_sequential ? EdgeKind::kSequential : EdgeKind::kClosure});
  }
  return edges;
}

#define LOOPGRID_INSTANTIATE(Pose)                                         \
  template GraphState StateOf(const PoseGraph<Pose>&, const std::string&); \
  template std::vector<GraphEdge> EdgesOf(const PoseGraph<Pose>&, const IdOrder&);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
