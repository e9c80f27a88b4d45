#include "backend/pose_graph.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numeric>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

int FindRoot(std::vector<int>* parent, int node) {
  auto& up = *parent;
  while (up[static_cast<std::size_t>(node)] != node) {
    int& above = up[static_cast<std::size_t>(node)];
    above = up[static_cast<std::size_t>(above)];
    node = above;
  }
  return node;
}

void RequireNode(const PoseGraph& graph, int node, const std::string& what) {
  if (node >= 0 && static_cast<std::size_t>(node) < graph.poses.size()) return;
  throw Error(ErrorCode::kInput, fmt::format("{} is node {}, but the graph has {} nodes", what,
                                             node, graph.poses.size()));
}

}  // namespace

void Validate(const PoseGraph& graph) {
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    if (!graph.poses[i].coordinates().allFinite()) {
      throw Error(ErrorCode::kInput, fmt::format("the pose of node {} is not finite", i));
    }
  }
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    const Constraint& constraint = graph.constraints[k];
    const auto count = static_cast<int>(graph.poses.size());
    if (constraint.from < 0 || constraint.from >= count || constraint.to < 0 ||
        constraint.to >= count) {
      RequireNode(graph, constraint.from, fmt::format("the start of constraint {}", k));
      RequireNode(graph, constraint.to, fmt::format("the end of constraint {}", k));
    }
    if (constraint.from == constraint.to) {
      throw Error(ErrorCode::kInput,
                  fmt::format("constraint {} joins node {} to itself", k, constraint.from));
    }
    if (!constraint.T_from_to.coordinates().allFinite() || !constraint.information.allFinite()) {
      throw Error(ErrorCode::kInput, fmt::format("constraint {} is not finite", k));
    }
  }
  for (int node : graph.fixed) RequireNode(graph, node, "a fixed node");
}

std::vector<int> ConnectedComponents(const PoseGraph& graph) {
  std::vector<int> parent(graph.poses.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const Constraint& constraint : graph.constraints) {
    const int a = FindRoot(&parent, constraint.from);
    const int b = FindRoot(&parent, constraint.to);
    // The lower index becomes the root, so that the root is the component's first node.
    if (a != b) parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  for (int i = 0; i < static_cast<int>(parent.size()); ++i) {
    parent[static_cast<std::size_t>(i)] = FindRoot(&parent, i);
  }
  return parent;
}

std::vector<int> HeldNodes(const PoseGraph& graph) {
  const std::vector<int> component = ConnectedComponents(graph);
  std::vector<bool> held(component.size(), false);
  std::vector<bool> has_fixed(component.size(), false);
  for (int node : graph.fixed) {
    held[static_cast<std::size_t>(node)] = true;
    has_fixed[static_cast<std::size_t>(component[static_cast<std::size_t>(node)])] = true;
  }
  std::vector<int> nodes;
  for (std::size_t i = 0; i < component.size(); ++i) {
    const bool is_first = component[i] == static_cast<int>(i);
    if (held[i] || (is_first && !has_fixed[i])) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

}  // namespace loopgrid
