#include "backend/graph/pose_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>

#include "backend/base/error.h"
#include "backend/base/index.h"
#include "backend/graph/information.h"

namespace loopgrid {
namespace {

int FindRoot(std::vector<int>* parent, int node) {
  auto& up = *parent;
  while (up[ToIndex(node)] != node) {
    int& above = up[ToIndex(node)];
    above = up[ToIndex(above)];
    node = above;
  }
  return node;
}

void Join(std::vector<int>* parent, int a, int b) {
  a = FindRoot(parent, a);
  b = FindRoot(parent, b);
  // The lower index becomes the root, so that the root is the component's first node.
  if (a != b) (*parent)[ToIndex(std::max(a, b))] = std::min(a, b);
}

template <typename Items>
void RequireIndex(const Items& items, int index, const char* where, std::size_t k,
                  const char* what) {
  if (index >= 0 && ToIndex(index) < items.size()) return;
  throw Error(ErrorCode::kInput, fmt::format("{} {} refers to {} {}, but the graph has {}", where,
                                             k, what, index, items.size()));
}

Error NotFinite(const std::string& what, std::size_t k) {
  return Error(ErrorCode::kInput, fmt::format("{} {} is not finite", what, k));
}

/// `edge()` says which one it is: "constraint 3 from node 1 to node 2".
template <int kSize, typename NameOfEdge>
void RequireInformation(const Eigen::Matrix<double, kSize, kSize>& information,
                        const NameOfEdge& edge) {
  if (const std::optional<AsymmetricEntry> entry = FindAsymmetry(information)) {
    const auto [row, column] = *entry;
    throw Error(ErrorCode::kInput,
                fmt::format("the information matrix of {} is not symmetric: {:.17g} at ({}, {}), "
                            "{:.17g} at ({}, {})",
                            edge(), information(row, column), row, column, information(column, row),
                            column, row));
  }
  if (const std::optional<double> eigenvalue = NegativeEigenvalue(information)) {
    throw Error(ErrorCode::kInput,
                fmt::format("the information matrix of {} is not positive semi-definite: its "
                            "smallest eigenvalue is {:.6g}",
                            edge(), *eigenvalue));
  }
}

template <typename Pose>
void ValidateConstraint(const PoseGraph<Pose>& graph, std::size_t k) {
  const Constraint<Pose>& constraint = graph.constraints[k];
  RequireIndex(graph.poses, constraint.from, "constraint", k, "node");
  RequireIndex(graph.poses, constraint.to, "constraint", k, "node");
  if (constraint.from == constraint.to) {
    throw Error(ErrorCode::kInput,
                fmt::format("constraint {} joins node {} to itself", k, constraint.from));
  }
  if (!constraint.T_from_to.IsFinite() || !constraint.information.allFinite()) {
    throw NotFinite("constraint", k);
  }
  RequireInformation(constraint.information, [&] {
    return fmt::format("constraint {} from node {} to node {}", k, constraint.from, constraint.to);
  });
}

template <typename Pose>
void ValidateObservation(const PoseGraph<Pose>& graph, std::size_t k) {
  const LandmarkObservation<Pose>& observation = graph.observations[k];
  RequireIndex(graph.poses, observation.node, "observation", k, "node");
  RequireIndex(graph.landmarks, observation.landmark, "observation", k, "landmark");
  if (!observation.p_node.allFinite() || !observation.information.allFinite()) {
    throw NotFinite("observation", k);
  }
  RequireInformation(observation.information, [&] {
    return fmt::format("observation {} of landmark {} from node {}", k, observation.landmark,
                       observation.node);
  });
}

}  // namespace

template <typename Pose>
void Validate(const PoseGraph<Pose>& graph) {
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    if (!graph.poses[i].IsFinite()) throw NotFinite("the pose of node", i);
  }
  for (std::size_t i = 0; i < graph.landmarks.size(); ++i) {
    if (!graph.landmarks[i].allFinite()) throw NotFinite("landmark", i);
  }
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) ValidateConstraint(graph, k);
  for (std::size_t k = 0; k < graph.observations.size(); ++k) ValidateObservation(graph, k);
  for (std::size_t k = 0; k < graph.fixed.size(); ++k) {
    RequireIndex(graph.poses, graph.fixed[k], "fixed node", k, "node");
  }
}

template <typename Pose>
Components ConnectedComponents(const PoseGraph<Pose>& graph) {
  const int nodes = static_cast<int>(graph.poses.size());
  std::vector<int> parent(graph.poses.size() + graph.landmarks.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& constraint : graph.constraints) Join(&parent, constraint.from, constraint.to);
  for (const auto& observation : graph.observations) {
    Join(&parent, observation.node, nodes + observation.landmark);
  }
  Components components;
  for (int i = 0; i < static_cast<int>(parent.size()); ++i) {
    const int root = FindRoot(&parent, i);
    if (i < nodes) {
      components.of_node.push_back(root);
    } else {
      components.of_landmark.push_back(root < nodes ? root : -1);
    }
  }
  return components;
}

template <typename Pose>
std::vector<int> HeldNodes(const PoseGraph<Pose>& graph, const Components& components) {
  const std::vector<int>& of_node = components.of_node;
  std::vector<bool> held(of_node.size(), false);
  std::vector<bool> has_fixed(of_node.size(), false);
  for (int node : graph.fixed) {
    held[ToIndex(node)] = true;
    has_fixed[ToIndex(of_node[ToIndex(node)])] = true;
  }
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(of_node.size()); ++node) {
    const bool is_first = of_node[ToIndex(node)] == node;
    if (held[ToIndex(node)] || (is_first && !has_fixed[ToIndex(node)])) nodes.push_back(node);
  }
  return nodes;
}

template <typename Pose>
std::int64_t DegreesOfFreedom(const PoseGraph<Pose>& graph, const Components& components) {
  constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  const std::int64_t moving = std::ssize(graph.poses) - std::ssize(HeldNodes(graph, components));
  const std::int64_t seen =
      std::ssize(graph.landmarks) -
      std::count(components.of_landmark.begin(), components.of_landmark.end(), -1);
  return Pose::kDof * (std::ssize(graph.constraints) - moving) +
         kPoint * (std::ssize(graph.observations) - seen);
}

#define LOOPGRID_INSTANTIATE(Pose)                                                \
  template void Validate(const PoseGraph<Pose>&);                                 \
  template Components ConnectedComponents(const PoseGraph<Pose>&);                \
  template std::vector<int> HeldNodes(const PoseGraph<Pose>&, const Components&); \
  template std::int64_t DegreesOfFreedom(const PoseGraph<Pose>&, const Components&);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
