#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "backend/base/worker_pool.h"
#include "backend/graph/parametrization.h"
#include "backend/graph/pose_graph.h"
#include "backend/graph/robust_loss.h"
#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {

/// The loss in F, the function that is minimised, and the coordinates of the increments.
struct Objective {
  RobustLoss loss;  ///< for the constraints and observations marked robust
  Parametrization parametrization = Parametrization::kManifold;
};

/// F at the graph's poses and landmarks: the sum over its edges, or over some of the constraints
/// and some of the observations.
template <typename Pose>
double TotalError(const PoseGraph<Pose>& graph, const Objective& objective);
template <typename Pose>
double TotalError(const PoseGraph<Pose>& graph, std::span<const Constraint<Pose>> constraints,
                  std::span<const LandmarkObservation<Pose>> observations,
                  const Objective& objective);

/// The Hessian H = sum J^T Omega J and gradient b = sum J^T Omega e of a graph (lines 6-13 of the
/// tutorial's Algorithm 2), over the nodes that are not held (see HeldNodes) and the landmarks. A
/// landmark takes the first rows of a block; the others have 1 on the diagonal. The block structure
/// is built once; when the graph has grown at its end since the last call, only the new part is
/// added.
template <typename Pose>
class NormalEquations {
 public:
  static constexpr int kDof = Pose::kDof;
  using Hessian = SymmetricBlockMatrix<kDof>;

  /// Prepares for the structure of the graph. Returns whether the block pattern of the Hessian has
  /// changed.
  bool SetStructure(const PoseGraph<Pose>& graph);

  /// Computes H and b at the graph's poses, each edge weighted by its loss; returns F. The results
  /// have the same bits for any number of workers, and without any.
  double Linearize(const PoseGraph<Pose>& graph, const Objective& objective,
                   WorkerPool* workers = nullptr);

  /// Position of a node or a landmark among the variables, -1 for a held node. Variables keep the
  /// order in which they joined the graph.
  int variable(int node) const { return variable_of_node_[static_cast<std::size_t>(node)]; }
  int landmark_variable(int landmark) const {
    return variable_of_landmark_[static_cast<std::size_t>(landmark)];
  }
  int landmark_count() const { return static_cast<int>(variable_of_landmark_.size()); }
  int variable_count() const { return hessian_.cols(); }

  const Components& components() const { return components_; }
  const Hessian& hessian() const { return hessian_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
  static constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  using Block = typename Hessian::Block;

  struct Link {
    int first;   // a node
    int second;  // a node or a landmark
    int block;   // off-diagonal block in the Hessian, -1 if an end is held
  };
  /// What one constraint or observation adds to the equations.
  struct Term {
    int first;  // variables
    int second;
    int block;
    Block H_first;
    Block H_second;
    Block H_upper;  // at (lower, higher variable)
    typename Pose::Tangent b_first;
    typename Pose::Tangent b_second;
    double cost;
  };

  bool IsGrown(const PoseGraph<Pose>& graph, const std::vector<int>& held) const;
  void AddVariables(const PoseGraph<Pose>& graph, const std::vector<int>& held);
  int FindOrAddBlock(int a, int b);
  void LinearizeTerm(const PoseGraph<Pose>& graph, const Constraint<Pose>& constraint,
                     const Link& link, const Objective& objective, Term* term) const;
  void LinearizeTerm(const PoseGraph<Pose>& graph, const LandmarkObservation<Pose>& observation,
                     const Link& link, const Objective& objective, Term* term) const;
  void Add(const Term& term);
  template <typename Edge>
  double LinearizeEdges(const PoseGraph<Pose>& graph, const std::vector<Edge>& edges,
                        const std::vector<Link>& links, const Objective& objective,
                        WorkerPool* workers);

  Components components_;
  std::vector<int> held_;
  std::vector<int> variable_of_node_;
  std::vector<int> variable_of_landmark_;
  std::vector<Link> links_;              // one per constraint
  std::vector<Link> observation_links_;  // one per observation
  std::vector<Term> terms_;              // of the edges being added
  Hessian hessian_;
  Eigen::VectorXd gradient_;
};

extern template class NormalEquations<SE2>;
extern template class NormalEquations<SE3>;

}  // namespace loopgrid
