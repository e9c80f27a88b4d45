#include "backend/pose_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

int FindRoot(std::vector<int>* parent, int node) {
  auto& up = *parent;
  while (up[Index(node)] != node) {
    int& above = up[Index(node)];
    above = up[Index(above)];
    node = above;
  }
  return node;
}

bool IsNode(const PoseGraph& graph, int node) {
  return node >= 0 && Index(node) < graph.poses.size();
}

Error NoSuchNode(const PoseGraph& graph, const std::string& where, int node) {
  return Error(ErrorCode::kInput, fmt::format("{} refers to node {}, but the graph has {} nodes",
                                              where, node, graph.poses.size()));
}

}  // namespace

void Validate(const PoseGraph& graph) {
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    if (graph.poses[i].coordinates().allFinite()) continue;
    throw Error(ErrorCode::kInput, fmt::format("the pose of node {} is not finite", i));
  }
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    const Constraint& constraint = graph.constraints[k];
    for (int node : {constraint.from, constraint.to}) {
      if (!IsNode(graph, node)) throw NoSuchNode(graph, fmt::format("constraint {}", k), node);
    }
    if (constraint.from == constraint.to) {
      throw Error(ErrorCode::kInput,
                  fmt::format("constraint {} joins node {} to itself", k, constraint.from));
    }
    if (!constraint.T_from_to.coordinates().allFinite() || !constraint.information.allFinite()) {
      throw Error(ErrorCode::kInput, fmt::format("constraint {} is not finite", k));
    }
  }
  for (int node : graph.fixed) {
    if (!IsNode(graph, node)) throw NoSuchNode(graph, "the list of fixed nodes", node);
  }
}

std::vector<int> ConnectedComponents(const PoseGraph& graph) {
  std::vector<int> parent(graph.poses.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const Constraint& constraint : graph.constraints) {
    const int a = FindRoot(&parent, constraint.from);
    const int b = FindRoot(&parent, constraint.to);
    // The lower index becomes the root, so that the root is the component's first node.
    if (a != b) parent[Index(std::max(a, b))] = std::min(a, b);
  }
  for (int i = 0; i < static_cast<int>(parent.size()); ++i) {
    parent[Index(i)] = FindRoot(&parent, i);
  }
  return parent;
}

std::vector<int> HeldNodes(const PoseGraph& graph, const std::vector<int>& components) {
  std::vector<bool> held(components.size(), false);
  std::vector<bool> has_fixed(components.size(), false);
  for (int node : graph.fixed) {
    held[Index(node)] = true;
    has_fixed[Index(components[Index(node)])] = true;
  }
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(components.size()); ++node) {
    const bool is_first = components[Index(node)] == node;
    if (held[Index(node)] || (is_first && !has_fixed[Index(node)])) nodes.push_back(node);
  }
  return nodes;
}

}  // namespace loopgrid
