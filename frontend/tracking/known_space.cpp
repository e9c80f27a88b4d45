#include "frontend/tracking/known_space.h"

#include <algorithm>
#include <numeric>

namespace loopgrid {
namespace {

double Distance(const PoseGraph<SE2>& graph, int node, const Eigen::Vector2d& position) {
  return (graph.poses[static_cast<std::size_t>(node)].translation() - position).norm();
}

}  // namespace

std::vector<int> NearestNodes(const PoseGraph<SE2>& graph, int end, const Eigen::Vector2d& position,
                              int count) {
  std::vector<std::pair<double, int>> nodes;
  nodes.reserve(static_cast<std::size_t>(std::max(end, 0)));
  for (int k = 0; k < end; ++k) nodes.emplace_back(Distance(graph, k, position), k);
  const auto last = nodes.begin() + std::min<std::ptrdiff_t>(count, std::ssize(nodes));
  std::partial_sort(nodes.begin(), last, nodes.end());
  std::vector<int> nearest;
  for (auto it = nodes.begin(); it != last; ++it) nearest.push_back(it->second);
  return nearest;
}

int NodesBehind(const PoseGraph<SE2>& graph, int session, const KnownSpaceOptions& options) {
  const int count = static_cast<int>(graph.poses.size());
  int node = count - 1;
  for (double path = 0.0; node > 0 && path <= options.recent_path; --node) {
    const auto k = static_cast<std::size_t>(node);
    path += (graph.poses[k].translation() - graph.poses[k - 1].translation()).norm();
  }
  return std::max(std::min(node, count - options.recent_nodes), session);
}

bool IsKnown(const PoseGraph<SE2>& graph, int end, int session, const Eigen::Vector2d& position,
             const KnownSpaceOptions& options) {
  int passes = 0;
  int last = -1 - options.same_pass;
  for (int k = 0; k < end; ++k) {
    if (Distance(graph, k, position) > options.distance) continue;
    if (k < session) return true;
    if (k - last > options.same_pass) ++passes;
    last = k;
  }
  return passes >= options.passes;
}

}  // namespace loopgrid
