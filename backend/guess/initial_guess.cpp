#include "backend/guess/initial_guess.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "backend/base/index.h"
#include "backend/graph/constraint_error.h"
#include "backend/sparse/sparse_cholesky.h"
#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Pose>
constexpr int kDim = Pose::Point::RowsAtCompileTime;
template <typename Pose>
using Matrix = Eigen::Matrix<double, kDim<Pose>, kDim<Pose>>;

SE2 MakePose(const Eigen::Matrix2d& R, const Eigen::Vector2d& t) {
  return {t.x(), t.y(), std::atan2(R(1, 0), R(0, 0))};
}

SE3 MakePose(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  return {t, Eigen::Quaterniond(R)};
}

/// The trace of the inverse of an information matrix; infinite where that says nothing.
template <typename Derived>
double TotalVariance(const Eigen::MatrixBase<Derived>& information) {
  const Eigen::SelfAdjointEigenSolver<typename Derived::PlainObject> solver(information,
                                                                            Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] > 0.0 ? solver.eigenvalues().cwiseInverse().sum() : kInfinity;
}

/// How far a node is from the roots of the tree: constraints that may be wrong and constraints
/// without information on the way, then the variance.
using Distance = std::tuple<int, int, double>;

template <typename Pose>
Distance Length(const Constraint<Pose>& constraint) {
  constexpr int kRotations = Pose::kDof - kDim<Pose>;
  const double variance = TotalVariance(
      constraint.information.template bottomRightCorner<kRotations, kRotations>().eval());
  const bool is_known = std::isfinite(variance);
  return {constraint.robust ? 1 : 0, is_known ? 0 : 1, is_known ? variance : 0.0};
}

Distance operator+(const Distance& a, const Distance& b) {
  return {std::get<0>(a) + std::get<0>(b), std::get<1>(a) + std::get<1>(b),
          std::get<2>(a) + std::get<2>(b)};
}

/// A forest over the constraints.
struct SpanningTree {
  std::vector<int> order;  // of the nodes, each after the one above it
  std::vector<int> link;   // for each node the constraint to the one above, -1 for roots
};

/// Shortest paths (Dijkstra 1959) from the held nodes; a part that they do not reach has its first
/// node as another root.
template <typename Pose>
class TreeBuilder {
 public:
  explicit TreeBuilder(const PoseGraph<Pose>& graph)
      : graph_(graph),
        links_of_node_(graph.poses.size()),
        distance_(graph.poses.size(), Distance{std::numeric_limits<int>::max(), 0, 0.0}),
        is_done_(graph.poses.size(), false) {
    lengths_.reserve(graph.constraints.size());
    for (const Constraint<Pose>& constraint : graph.constraints) {
      const int k = static_cast<int>(lengths_.size());
      links_of_node_[ToIndex(constraint.from)].push_back(k);
      links_of_node_[ToIndex(constraint.to)].push_back(k);
      lengths_.push_back(Length(constraint));
    }
    tree_.link.assign(graph.poses.size(), -1);
  }

  SpanningTree Build() && {
    for (int node : HeldNodes(graph_, ConnectedComponents(graph_))) AddRoot(node);
    Grow();
    for (int node = 0; node < static_cast<int>(graph_.poses.size()); ++node) {
      if (is_done_[ToIndex(node)]) continue;
      AddRoot(node);
      Grow();
    }
    return std::move(tree_);
  }

 private:
  using Reached = std::pair<Distance, int>;  // ties go to the lower node

  void AddRoot(int node) {
    distance_[ToIndex(node)] = {};
    reached_.push({{}, node});
  }

  void Grow() {
    while (!reached_.empty()) {
      const int node = reached_.top().second;
      reached_.pop();
      if (is_done_[ToIndex(node)]) continue;
      is_done_[ToIndex(node)] = true;
      tree_.order.push_back(node);
      for (int k : links_of_node_[ToIndex(node)]) Reach(node, k);
    }
  }

  void Reach(int node, int k) {
    const Constraint<Pose>& constraint = graph_.constraints[ToIndex(k)];
    const int other = constraint.from == node ? constraint.to : constraint.from;
    const Distance distance = distance_[ToIndex(node)] + lengths_[ToIndex(k)];
    if (is_done_[ToIndex(other)] || distance >= distance_[ToIndex(other)]) return;
    distance_[ToIndex(other)] = distance;
    tree_.link[ToIndex(other)] = k;
    reached_.push({distance, other});
  }

  const PoseGraph<Pose>& graph_;
  std::vector<std::vector<int>> links_of_node_;
  std::vector<Distance> lengths_;  // of the constraints
  std::vector<Distance> distance_;
  std::vector<bool> is_done_;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> reached_;
  SpanningTree tree_;
};

template <typename Pose>
void PlaceLandmarks(PoseGraph<Pose>* graph) {
  std::vector<const LandmarkObservation<Pose>*> best(graph->landmarks.size(), nullptr);
  std::vector<std::pair<bool, double>> doubt(best.size(), {true, kInfinity});
  for (const LandmarkObservation<Pose>& observation : graph->observations) {
    const std::size_t landmark = ToIndex(observation.landmark);
    const std::pair<bool, double> its{observation.robust, TotalVariance(observation.information)};
    if (best[landmark] != nullptr && its >= doubt[landmark]) continue;
    best[landmark] = &observation;
    doubt[landmark] = its;
  }
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] == nullptr) continue;
    graph->landmarks[i] = graph->poses[ToIndex(best[i]->node)] * best[i]->p_node;
  }
}

/// What a constraint or observation counts that may be wrong, against the others: so little that
/// some hundreds of wrong ones hardly bend what the others say, and enough to place nodes that
/// nothing else joins to the rest.
constexpr double kWeightIfRobust = 1e-6;

template <typename Edge>
double WeightOf(const Edge& edge) {
  return edge.robust ? kWeightIfRobust : 1.0;
}

/// Of a constraint's rotation, one number: with more, matrices that are no rotations become cheap.
template <typename Pose>
double RotationWeight(const Constraint<Pose>& constraint) {
  constexpr int kTurns = Pose::kDof - kDim<Pose>;
  return WeightOf(constraint) * constraint.information.diagonal().template tail<kTurns>().mean();
}

/// The rotation nearest to a matrix in the Frobenius norm.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> NearestRotation(
    const Eigen::Matrix<double, kSize, kSize>& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix<double, kSize, kSize>> svd(
      matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix<double, kSize, kSize> U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(kSize - 1) *= -1.0;
  return U * svd.matrixV().transpose();
}

/// Sparse linear least squares for blocks of kSize unknowns, with some columns of right-hand sides.
template <int kSize>
class LeastSquares {
 public:
  using Block = Eigen::Matrix<double, kSize, kSize>;

  LeastSquares(int variables, int columns) : b_(Eigen::MatrixXd::Zero(kSize * variables, columns)) {
    H_.Resize(variables);
  }

  void AddSquare(int variable, const Block& block) {
    if (variable >= 0) H_.diagonal(variable) += block;
  }
  void AddProduct(int row, int col, const Block& block) {
    if (row < 0 || col < 0) return;
    if (row < col) {
      H_.off_diagonal(H_.FindOrAddBlock(row, col)) += block;
    } else {
      H_.off_diagonal(H_.FindOrAddBlock(col, row)) += block.transpose();
    }
  }
  template <typename Derived>
  void AddRight(int variable, const Eigen::MatrixBase<Derived>& rows) {
    if (variable >= 0) b_.middleRows<kSize>(kSize * variable) += rows;
  }

  /// By a factor whose elimination order may be of use.
  std::optional<Eigen::MatrixXd> Solve(SparseCholesky<kSize>* factor) const {
    if (H_.cols() == 0) return b_;
    factor->Analyze(H_);
    if (!factor->Factorize(H_)) return std::nullopt;
    Eigen::MatrixXd x = factor->Solve(b_);
    if (!x.allFinite()) return std::nullopt;
    return x;
  }

 private:
  SymmetricBlockMatrix<kSize> H_;
  Eigen::MatrixXd b_;
};

/// The tree's roots keep their rotations; for each of the other nodes |R_to - R_from * R_from_to|
/// is made small, weighted. The rows of the matrices do not mix: the unknowns are the transposed
/// rotations, whose columns are so many right-hand sides of one system.
template <typename Pose>
bool SolveRotations(const SpanningTree& tree, SparseCholesky<kDim<Pose>>* factor,
                    PoseGraph<Pose>* graph) {
  constexpr int kSize = kDim<Pose>;
  std::vector<int> variable_of(graph->poses.size(), -1);
  int count = 0;
  for (std::size_t node = 0; node < variable_of.size(); ++node) {
    if (tree.link[node] >= 0) variable_of[node] = count++;
  }
  LeastSquares<kSize> system(count, kSize);
  for (const Constraint<Pose>& constraint : graph->constraints) {
    const double weight = RotationWeight(constraint);
    const Matrix<Pose> product = weight * constraint.T_from_to.rotation();
    const Matrix<Pose> square = weight * Matrix<Pose>::Identity();
    const int from = variable_of[ToIndex(constraint.from)];
    const int to = variable_of[ToIndex(constraint.to)];
    system.AddSquare(from, square);
    system.AddSquare(to, square);
    system.AddProduct(from, to, -product);
    if (from < 0) {
      const Matrix<Pose> known = graph->poses[ToIndex(constraint.from)].rotation();
      system.AddRight(to, (known * product).transpose());
    }
    if (to < 0) {
      const Matrix<Pose> known = graph->poses[ToIndex(constraint.to)].rotation();
      system.AddRight(from, product * known.transpose());
    }
  }
  const std::optional<Eigen::MatrixXd> rows = system.Solve(factor);
  if (!rows) return false;
  for (std::size_t node = 0; node < variable_of.size(); ++node) {
    if (variable_of[node] < 0) continue;
    const Matrix<Pose> relaxed =
        rows->template middleRows<kSize>(kSize * variable_of[node]).transpose();
    Pose& pose = graph->poses[node];
    pose = MakePose(NearestRotation<kSize>(relaxed), pose.translation());
  }
  return true;
}

/// Minimises F, weighted, over the positions of the nodes that are not held and of the landmarks:
/// one step of Gauss-Newton, since errors are linear in them.
template <typename Pose>
bool SolvePositions(SparseCholesky<kDim<Pose>>* factor, PoseGraph<Pose>* graph) {
  constexpr int kSize = kDim<Pose>;
  const Components components = ConnectedComponents(*graph);
  int count = 0;
  std::vector<int> variable_of(graph->poses.size(), 0);
  for (int node : HeldNodes(*graph, components)) variable_of[ToIndex(node)] = -1;
  for (int& variable : variable_of) variable = variable < 0 ? -1 : count++;
  std::vector<int> variable_of_landmark(graph->landmarks.size(), -1);
  for (std::size_t i = 0; i < variable_of_landmark.size(); ++i) {
    if (components.of_landmark[i] >= 0) variable_of_landmark[i] = count++;
  }

  LeastSquares<kSize> system(count, 1);
  // e changes by J * (move of b - move of a).
  const auto add = [&system](int a, int b, const Matrix<Pose>& J, const Matrix<Pose>& information,
                             const typename Pose::Point& information_error) {
    const Matrix<Pose> H = J.transpose() * information * J;
    system.AddSquare(a, H);
    system.AddSquare(b, H);
    system.AddProduct(a, b, -H);
    const typename Pose::Point gradient = J.transpose() * information_error;
    system.AddRight(a, gradient);
    system.AddRight(b, -gradient);
  };
  for (const Constraint<Pose>& c : graph->constraints) {
    const Pose& from = graph->poses[ToIndex(c.from)];
    const typename Pose::Tangent error =
        ConstraintError(from, graph->poses[ToIndex(c.to)], c.T_from_to);
    add(variable_of[ToIndex(c.from)], variable_of[ToIndex(c.to)],
        (from.rotation() * c.T_from_to.rotation()).transpose(),
        WeightOf(c) * c.information.template topLeftCorner<kSize, kSize>(),
        WeightOf(c) * c.information.template topRows<kSize>() * error);
  }
  for (const LandmarkObservation<Pose>& observation : graph->observations) {
    const Pose& node = graph->poses[ToIndex(observation.node)];
    const typename Pose::Point error =
        ObservationError(node, graph->landmarks[ToIndex(observation.landmark)], observation.p_node);
    add(variable_of[ToIndex(observation.node)], variable_of_landmark[ToIndex(observation.landmark)],
        node.rotation().transpose(), WeightOf(observation) * observation.information,
        WeightOf(observation) * observation.information * error);
  }
  const std::optional<Eigen::MatrixXd> moves = system.Solve(factor);
  if (!moves) return false;
  const auto move = [&moves](int variable) {
    return moves->template middleRows<kSize>(kSize * variable);
  };
  for (std::size_t node = 0; node < variable_of.size(); ++node) {
    if (variable_of[node] < 0) continue;
    Pose& pose = graph->poses[node];
    pose = MakePose(pose.rotation(), pose.translation() + move(variable_of[node]));
  }
  for (std::size_t i = 0; i < variable_of_landmark.size(); ++i) {
    if (variable_of_landmark[i] >= 0) graph->landmarks[i] += move(variable_of_landmark[i]);
  }
  return true;
}

}  // namespace

template <typename Pose>
void SetSpanningTreeGuess(PoseGraph<Pose>* graph) {
  Validate(*graph);
  const SpanningTree tree = TreeBuilder<Pose>(*graph).Build();
  for (int node : tree.order) {
    const int k = tree.link[ToIndex(node)];
    if (k < 0) continue;
    const Constraint<Pose>& constraint = graph->constraints[ToIndex(k)];
    graph->poses[ToIndex(node)] =
        constraint.to == node
            ? graph->poses[ToIndex(constraint.from)] * constraint.T_from_to
            : graph->poses[ToIndex(constraint.to)] * constraint.T_from_to.Inverse();
  }
  PlaceLandmarks(graph);
}

template <typename Pose>
bool SetChordalGuess(PoseGraph<Pose>* graph) {
  Validate(*graph);
  std::vector<Pose> poses = graph->poses;
  SparseCholesky<kDim<Pose>> factor;
  if (SolveRotations(TreeBuilder<Pose>(*graph).Build(), &factor, graph) &&
      SolvePositions(&factor, graph)) {
    return true;
  }
  graph->poses = std::move(poses);
  return false;
}

#define LOOPGRID_INSTANTIATE(Pose)                      \
  template void SetSpanningTreeGuess(PoseGraph<Pose>*); \
  template bool SetChordalGuess(PoseGraph<Pose>*);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
