#include "backend/normal_equations.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "backend/constraint_error.h"

namespace loopgrid {

bool NormalEquations::IsGrown(const PoseGraph& graph, const std::vector<int>& held) const {
  if (graph.poses.size() < variable_of_node_.size() || graph.constraints.size() < links_.size()) {
    return false;
  }
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Constraint& constraint = graph.constraints[k];
    if (constraint.from != links_[k].from || constraint.to != links_[k].to) return false;
  }
  // The held nodes among the known ones must be the same.
  const auto known =
      std::lower_bound(held.begin(), held.end(), static_cast<int>(variable_of_node_.size()));
  return std::equal(held.begin(), known, held_.begin(), held_.end());
}

void NormalEquations::AddNodes(int count, const std::vector<int>& held) {
  int next = hessian_.cols();
  for (int node = static_cast<int>(variable_of_node_.size()); node < count; ++node) {
    const bool is_held = std::binary_search(held.begin(), held.end(), node);
    variable_of_node_.push_back(is_held ? -1 : next++);
  }
  hessian_.Resize(next);
  gradient_.resize(3 * next);
}

bool NormalEquations::SetStructure(const PoseGraph& graph) {
  components_ = ConnectedComponents(graph);
  std::vector<int> held = HeldNodes(graph, components_);
  const bool is_grown = IsGrown(graph, held);
  if (!is_grown) {
    variable_of_node_.clear();
    links_.clear();
    hessian_.Clear();
  }
  const int old_variables = hessian_.cols();
  const int old_blocks = hessian_.block_count();
  AddNodes(static_cast<int>(graph.poses.size()), held);
  held_ = std::move(held);
  for (std::size_t k = links_.size(); k < graph.constraints.size(); ++k) {
    const Constraint& constraint = graph.constraints[k];
    const int from = variable(constraint.from);
    const int to = variable(constraint.to);
    const bool both_free = from >= 0 && to >= 0;
    const int block =
        both_free ? hessian_.FindOrAddBlock(std::min(from, to), std::max(from, to)) : -1;
    links_.push_back({constraint.from, constraint.to, block});
  }
  return !is_grown || hessian_.cols() != old_variables || hessian_.block_count() != old_blocks;
}

double NormalEquations::Linearize(const PoseGraph& graph, const RobustLoss& loss) {
  hessian_.SetZero();
  gradient_.setZero();
  double total = 0.0;
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Constraint& constraint = graph.constraints[k];
    const LinearizedConstraint linear = loopgrid::Linearize(
        graph.poses[static_cast<std::size_t>(constraint.from)],
        graph.poses[static_cast<std::size_t>(constraint.to)], constraint.T_from_to);
    const Eigen::Vector3d information_error = constraint.information * linear.error;
    const double chi2 = linear.error.dot(information_error);
    const LossValue value = constraint.robust ? loss.Evaluate(chi2) : LossValue{chi2, 1.0};
    total += value.cost;

    const Eigen::Matrix3d weighted = value.weight * constraint.information;
    const Eigen::Matrix3d A = weighted * linear.J_from;
    const Eigen::Matrix3d B = weighted * linear.J_to;
    const int from = variable(constraint.from);
    const int to = variable(constraint.to);
    if (from >= 0) {
      hessian_.diagonal(from).noalias() += linear.J_from.transpose() * A;
      gradient_.segment<3>(3 * from) +=
          value.weight * linear.J_from.transpose() * information_error;
    }
    if (to >= 0) {
      hessian_.diagonal(to).noalias() += linear.J_to.transpose() * B;
      gradient_.segment<3>(3 * to) += value.weight * linear.J_to.transpose() * information_error;
    }
    if (links_[k].block < 0) continue;
    if (from < to) {
      hessian_.off_diagonal(links_[k].block).noalias() += linear.J_from.transpose() * B;
    } else {
      hessian_.off_diagonal(links_[k].block).noalias() += linear.J_to.transpose() * A;
    }
  }
  return total;
}

double NormalEquations::Error(const PoseGraph& graph, const RobustLoss& loss) {
  double total = 0.0;
  for (const Constraint& constraint : graph.constraints) {
    const double chi2 = Chi2(graph, constraint);
    total += constraint.robust ? loss.Evaluate(chi2).cost : chi2;
  }
  return total;
}

}  // namespace loopgrid
