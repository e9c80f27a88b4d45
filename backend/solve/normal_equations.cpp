#include "backend/solve/normal_equations.h"

#include "backend/base/index.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace loopgrid {
namespace {

/// Terms that are computed before they are added: few enough to stay in the cache.
constexpr std::size_t kTermsAThread = 32;
/// Handing out work to other threads takes as long as some hundreds of terms.
constexpr std::size_t kTermsAHelper = 2048;

LossValue Evaluate(const RobustLoss& loss, bool robust, double chi2) {
  return robust ? loss.Evaluate(chi2) : LossValue{chi2, 1.0};
}

template <typename Edge>
bool HasEnds(const Edge& edge, int first, int second) {
  if constexpr (requires { edge.landmark; }) {
    return edge.node == first && edge.landmark == second;
  } else {
    return edge.from == first && edge.to == second;
  }
}

}  // namespace

template <typename Pose>
double TotalError(const PoseGraph<Pose>& graph, const Objective& objective) {
  return TotalError<Pose>(graph, graph.constraints, graph.observations, objective);
}

template <typename Pose>
double TotalError(const PoseGraph<Pose>& graph, std::span<const Constraint<Pose>> constraints,
                  std::span<const LandmarkObservation<Pose>> observations,
                  const Objective& objective) {
  double total = 0.0;
  for (const Constraint<Pose>& c : constraints) {
    const typename Pose::Tangent error =
        ConstraintError(graph.poses[ToIndex(c.from)], graph.poses[ToIndex(c.to)], c.T_from_to,
                        objective.parametrization);
    total += Evaluate(objective.loss, c.robust, error.dot(c.information * error)).cost;
  }
  for (const LandmarkObservation<Pose>& observation : observations) {
    total += Evaluate(objective.loss, observation.robust, Chi2(graph, observation)).cost;
  }
  return total;
}

template <typename Pose>
bool NormalEquations<Pose>::IsGrown(const PoseGraph<Pose>& graph,
                                    const std::vector<int>& held) const {
  if (graph.poses.size() < variable_of_node_.size() ||
      graph.landmarks.size() < variable_of_landmark_.size() ||
      graph.constraints.size() < links_.size() ||
      graph.observations.size() < observation_links_.size()) {
    return false;
  }
  const auto begins_with = [](const auto& edges, const std::vector<Link>& links) {
    return std::equal(
        links.begin(), links.end(), edges.begin(),
        [](const Link& link, const auto& edge) { return HasEnds(edge, link.first, link.second); });
  };
  if (!begins_with(graph.constraints, links_) ||
      !begins_with(graph.observations, observation_links_)) {
    return false;
  }
  // A landmark may have been waiting to be seen.
  for (std::size_t i = 0; i < variable_of_landmark_.size(); ++i) {
    if (variable_of_landmark_[i] < 0 && components_.of_landmark[i] >= 0) return false;
  }
  // The held nodes among the known ones must be the same.
  const auto known =
      std::lower_bound(held.begin(), held.end(), static_cast<int>(variable_of_node_.size()));
  return std::equal(held.begin(), known, held_.begin(), held_.end());
}

template <typename Pose>
void NormalEquations<Pose>::AddVariables(const PoseGraph<Pose>& graph,
                                         const std::vector<int>& held) {
  int next = hessian_.cols();
  for (int node = static_cast<int>(variable_of_node_.size());
       node < static_cast<int>(graph.poses.size()); ++node) {
    const bool is_held = std::binary_search(held.begin(), held.end(), node);
    variable_of_node_.push_back(is_held ? -1 : next++);
  }
  while (variable_of_landmark_.size() < graph.landmarks.size()) {
    // Nothing moves a landmark that no node has seen.
    const bool is_seen = components_.of_landmark[variable_of_landmark_.size()] >= 0;
    variable_of_landmark_.push_back(is_seen ? next++ : -1);
  }
  hessian_.Resize(next);
  gradient_.resize(kDof * next);
}

template <typename Pose>
int NormalEquations<Pose>::FindOrAddBlock(int a, int b) {
  return a >= 0 && b >= 0 ? hessian_.FindOrAddBlock(std::min(a, b), std::max(a, b)) : -1;
}

template <typename Pose>
bool NormalEquations<Pose>::SetStructure(const PoseGraph<Pose>& graph) {
  components_ = ConnectedComponents(graph);
  std::vector<int> held = HeldNodes(graph, components_);
  const bool is_grown = IsGrown(graph, held);
  if (!is_grown) {
    variable_of_node_.clear();
    variable_of_landmark_.clear();
    links_.clear();
    observation_links_.clear();
    hessian_.Clear();
  }
  const int old_variables = hessian_.cols();
  const int old_blocks = hessian_.block_count();
  AddVariables(graph, held);
  held_ = std::move(held);
  for (std::size_t k = links_.size(); k < graph.constraints.size(); ++k) {
    const Constraint<Pose>& c = graph.constraints[k];
    links_.push_back({c.from, c.to, FindOrAddBlock(variable(c.from), variable(c.to))});
  }
  for (std::size_t k = observation_links_.size(); k < graph.observations.size(); ++k) {
    const LandmarkObservation<Pose>& o = graph.observations[k];
    observation_links_.push_back(
        {o.node, o.landmark, FindOrAddBlock(variable(o.node), landmark_variable(o.landmark))});
  }
  return !is_grown || hessian_.cols() != old_variables || hessian_.block_count() != old_blocks;
}

template <typename Pose>
void NormalEquations<Pose>::LinearizeTerm(const PoseGraph<Pose>& graph,
                                          const Constraint<Pose>& constraint, const Link& link,
                                          const Objective& objective, Term* term) const {
  const LinearizedConstraint<Pose> linear = loopgrid::Linearize(
      graph.poses[ToIndex(constraint.from)], graph.poses[ToIndex(constraint.to)],
      constraint.T_from_to, objective.parametrization);
  const typename Pose::Tangent information_error = constraint.information * linear.error;
  const LossValue value =
      Evaluate(objective.loss, constraint.robust, linear.error.dot(information_error));
  const Block weighted = value.weight * constraint.information;
  const Block A = weighted * linear.J_from;
  const Block B = weighted * linear.J_to;
  term->cost = value.cost;
  term->first = variable(link.first);
  term->second = variable(link.second);
  term->block = link.block;
  term->H_first.noalias() = linear.J_from.transpose() * A;
  term->H_second.noalias() = linear.J_to.transpose() * B;
  term->b_first = value.weight * linear.J_from.transpose() * information_error;
  term->b_second = value.weight * linear.J_to.transpose() * information_error;
  if (term->first < term->second) {
    term->H_upper.noalias() = linear.J_from.transpose() * B;
  } else {
    term->H_upper.noalias() = linear.J_to.transpose() * A;
  }
}

template <typename Pose>
void NormalEquations<Pose>::LinearizeTerm(const PoseGraph<Pose>& graph,
                                          const LandmarkObservation<Pose>& observation,
                                          const Link& link, const Objective& objective,
                                          Term* term) const {
  const LinearizedObservation<Pose> linear = loopgrid::Linearize(
      graph.poses[ToIndex(observation.node)], graph.landmarks[ToIndex(observation.landmark)],
      observation.p_node, objective.parametrization);
  const typename Pose::Point information_error = observation.information * linear.error;
  const LossValue value =
      Evaluate(objective.loss, observation.robust, linear.error.dot(information_error));
  const typename LandmarkObservation<Pose>::Information weighted =
      value.weight * observation.information;
  term->cost = value.cost;
  term->first = variable(link.first);
  term->second = landmark_variable(link.second);
  term->block = link.block;
  term->H_first = linear.J_node.transpose() * weighted * linear.J_node;
  term->b_first = value.weight * linear.J_node.transpose() * information_error;
  term->H_second.setZero();
  term->H_second.template topLeftCorner<kPoint, kPoint>() =
      linear.J_landmark.transpose() * weighted * linear.J_landmark;
  term->b_second.setZero();
  term->b_second.template head<kPoint>() =
      value.weight * linear.J_landmark.transpose() * information_error;
  term->H_upper.setZero();
  const Eigen::Matrix<double, kDof, kPoint> mixed =
      linear.J_node.transpose() * weighted * linear.J_landmark;
  if (term->first < term->second) {
    term->H_upper.template leftCols<kPoint>() = mixed;
  } else {
    term->H_upper.template topRows<kPoint>() = mixed.transpose();
  }
}

template <typename Pose>
void NormalEquations<Pose>::Add(const Term& term) {
  if (term.first >= 0) {
    hessian_.diagonal(term.first) += term.H_first;
    gradient_.template segment<kDof>(kDof * term.first) += term.b_first;
  }
  if (term.second >= 0) {
    hessian_.diagonal(term.second) += term.H_second;
    gradient_.template segment<kDof>(kDof * term.second) += term.b_second;
  }
  if (term.block >= 0) hessian_.off_diagonal(term.block) += term.H_upper;
}

template <typename Pose>
template <typename Edge>
double NormalEquations<Pose>::LinearizeEdges(const PoseGraph<Pose>& graph,
                                             const std::vector<Edge>& edges,
                                             const std::vector<Link>& links,
                                             const Objective& objective, WorkerPool* workers) {
  const bool is_shared =
      workers != nullptr && workers->threads() > 1 && edges.size() >= kTermsAHelper;
  const std::size_t batch =
      is_shared ? kTermsAHelper * static_cast<std::size_t>(workers->threads()) : kTermsAThread;
  terms_.resize(std::min(batch, edges.size()));
  double total = 0.0;
  for (std::size_t first = 0; first < edges.size(); first += batch) {
    const std::size_t count = std::min(batch, edges.size() - first);
    const auto linearize = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        LinearizeTerm(graph, edges[first + k], links[first + k], objective, &terms_[k]);
      }
    };
    if (is_shared) {
      workers->Run(count, linearize);
    } else {
      linearize(0, count);
    }
    // Added one after the other, in the order of the edges: the same sums for any number of
    // threads.
    for (std::size_t k = 0; k < count; ++k) {
      Add(terms_[k]);
      total += terms_[k].cost;
    }
  }
  return total;
}

template <typename Pose>
double NormalEquations<Pose>::Linearize(const PoseGraph<Pose>& graph, const Objective& objective,
                                        WorkerPool* workers) {
  hessian_.SetZero();
  gradient_.setZero();
  for (int variable : variable_of_landmark_) {
    if (variable < 0) continue;
    hessian_.diagonal(variable).diagonal().template tail<kDof - kPoint>().setOnes();
  }
  const double total = LinearizeEdges(graph, graph.constraints, links_, objective, workers);
  return total + LinearizeEdges(graph, graph.observations, observation_links_, objective, workers);
}

#define LOOPGRID_INSTANTIATE(Pose)                                                          \
  template double TotalError(const PoseGraph<Pose>&, const Objective&);                     \
  template double TotalError(const PoseGraph<Pose>&, std::span<const Constraint<Pose>>,     \
                             std::span<const LandmarkObservation<Pose>>, const Objective&); \
  template class NormalEquations<Pose>;
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
