#include "backend/global/global_optimality.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "backend/base/index.h"
#include "backend/global/quadratic_minorant.h"
#include "backend/graph/constraint_error.h"
#include "backend/solve/optimizer.h"
#include "backend/sparse/sparse_cholesky.h"
#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {
namespace {

using Kind = OptimalityCertificate::Kind;

constexpr double kRelativeGap = 1e-6;
constexpr double kAbsoluteGap = 1e-9;

/// Steps of Gauss-Newton that bring a point to its minimum, if it is near one, as far as the
/// arithmetic goes.
constexpr int kPolishingSteps = 5;
constexpr double kPolished = 1e-14;

/// The sum of the minorants as a function of v, the change of the pose matrices X = (R, t) of the
/// nodes that are not held and of the landmarks (of which only t counts). The rows of X do not mix.
/// Where R + v is orthonormal, the Lagrange terms tr(Lambda (R + v)^T (R + v)) are constant, and so
/// sum(v) = sum(0) + 2 <G, v> + <v, v S>, with S and G without and with the terms.
template <typename Pose>
class DualProblem {
 public:
  static constexpr int kDim = Pose::Point::RowsAtCompileTime;
  static constexpr int kBlock = kDim + 1;
  using Point = typename Pose::Point;
  using Matrix = Eigen::Matrix<double, kDim, kDim>;

  DualProblem(const PoseGraph<Pose>& graph, MinorantOf3dRotation kind);

  /// How far below F at these poses any other can be at most; infinite where S is not positive
  /// definite, which leaves the question open.
  double LargestDecrease() const;

 private:
  void Add(int first, int second, const Pose& from, const Matrix& R_to, const Point& t_to,
           const QuadraticMinorant<Pose>& minorant);
  void AddMultipliers(const PoseGraph<Pose>& graph);
  auto gradient(int variable) { return gradient_.template middleRows<kBlock>(kBlock * variable); }

  std::vector<int> variable_of_node_;
  std::vector<int> variable_of_landmark_;
  SymmetricBlockMatrix<kBlock> S_;
  Eigen::MatrixXd gradient_;  // G, transposed: a column for each row of X
  double slack_ = 0.0;
};

template <typename Pose>
DualProblem<Pose>::DualProblem(const PoseGraph<Pose>& graph, MinorantOf3dRotation kind)
    : variable_of_node_(graph.poses.size(), 0), variable_of_landmark_(graph.landmarks.size(), -1) {
  const Components components = ConnectedComponents(graph);
  int count = 0;
  for (int node : HeldNodes(graph, components)) variable_of_node_[ToIndex(node)] = -1;
  for (int& variable : variable_of_node_) variable = variable < 0 ? -1 : count++;
  for (std::size_t i = 0; i < variable_of_landmark_.size(); ++i) {
    if (components.of_landmark[i] >= 0) variable_of_landmark_[i] = count++;
  }
  S_.Resize(count);
  gradient_.setZero(kBlock * count, kDim);
  for (const Constraint<Pose>& c : graph.constraints) {
    const Pose& to = graph.poses[ToIndex(c.to)];
    Add(variable_of_node_[ToIndex(c.from)], variable_of_node_[ToIndex(c.to)],
        graph.poses[ToIndex(c.from)], to.rotation(), to.translation(), Minorize(graph, c, kind));
  }
  for (const LandmarkObservation<Pose>& observation : graph.observations) {
    Add(variable_of_node_[ToIndex(observation.node)],
        variable_of_landmark_[ToIndex(observation.landmark)],
        graph.poses[ToIndex(observation.node)], Matrix::Zero(),
        graph.landmarks[ToIndex(observation.landmark)], Minorize(graph, observation));
  }
  AddMultipliers(graph);
}

template <typename Pose>
void DualProblem<Pose>::Add(int first, int second, const Pose& from, const Matrix& R_to,
                            const Point& t_to, const QuadraticMinorant<Pose>& minorant) {
  slack_ += minorant.slack;
  const Point step = t_to - from.translation();
  const Point slope = minorant.alpha * step + from.rotation() * minorant.beta;
  if (first >= 0) {
    auto& square = S_.diagonal(first);
    square(kDim, kDim) += minorant.alpha;
    square.template topRightCorner<kDim, 1>() -= minorant.beta;
    square.template bottomLeftCorner<1, kDim>() -= minorant.beta.transpose();
    gradient(first).template topRows<kDim>() +=
        minorant.beta * step.transpose() + minorant.M * R_to.transpose();
    gradient(first).row(kDim) -= slope.transpose();
  }
  if (second >= 0) {
    S_.diagonal(second)(kDim, kDim) += minorant.alpha;
    gradient(second).template topRows<kDim>() +=
        minorant.M.transpose() * from.rotation().transpose();
    gradient(second).row(kDim) += slope.transpose();
  }
  if (first < 0 || second < 0) return;
  typename SymmetricBlockMatrix<kBlock>::Block product;
  product << minorant.M, minorant.beta, Eigen::Matrix<double, 1, kDim>::Zero(), -minorant.alpha;
  if (first < second) {
    S_.off_diagonal(S_.FindOrAddBlock(first, second)) += product;
  } else {
    S_.off_diagonal(S_.FindOrAddBlock(second, first)) += product.transpose();
  }
}

/// Lambda = sym(R^T G): those with which G is zero at a critical point of F.
template <typename Pose>
void DualProblem<Pose>::AddMultipliers(const PoseGraph<Pose>& graph) {
  for (std::size_t node = 0; node < variable_of_node_.size(); ++node) {
    const int variable = variable_of_node_[node];
    if (variable < 0) continue;
    const Matrix R = graph.poses[node].rotation();
    auto rotation = gradient(variable).template topRows<kDim>();
    const Matrix product = rotation * R;
    const Matrix multiplier = 0.5 * (product + product.transpose());
    rotation -= multiplier * R.transpose();
    S_.diagonal(variable).template topLeftCorner<kDim, kDim>() -= multiplier;
  }
  for (int variable : variable_of_landmark_) {
    if (variable >= 0) S_.diagonal(variable).diagonal().template head<kDim>().setOnes();
  }
}

template <typename Pose>
double DualProblem<Pose>::LargestDecrease() const {
  if (S_.cols() == 0) return 0.0;
  SparseCholesky<kBlock> factor;
  factor.Analyze(S_);
  if (!factor.Factorize(S_)) return std::numeric_limits<double>::infinity();
  // The minimum of 2 <G, v> + <v, v S> over all v, those that are no rotations included.
  return slack_ + gradient_.cwiseProduct(factor.Solve(gradient_)).sum();
}

/// The best bound that this point gives, 0 if it gives none.
template <typename Pose>
double LowerBound(const PoseGraph<Pose>& graph) {
  const double error = TotalChi2(graph);
  double decrease = DualProblem<Pose>(graph, MinorantOf3dRotation::kExact).LargestDecrease();
  if constexpr (Pose::Point::RowsAtCompileTime == 3) {
    if (!std::isfinite(decrease)) {
      decrease = DualProblem<Pose>(graph, MinorantOf3dRotation::kConvex).LargestDecrease();
    }
  }
  return std::max(0.0, error - decrease);
}

}  // namespace

const char* ToString(OptimalityCertificate::Kind kind) {
  switch (kind) {
    case Kind::kGlobal:
      return "global optimum";
    case Kind::kBounded:
      return "not far above the global optimum";
    case Kind::kUnknown:
      break;
  }
  return "could not be told to be the global optimum";
}

template <typename Pose>
OptimalityCertificate CertifyOptimality(const PoseGraph<Pose>& graph) {
  Validate(graph);
  OptimalityCertificate certificate;
  certificate.error = TotalChi2(graph);
  const double negligible = std::max(kAbsoluteGap, kRelativeGap * certificate.error);
  const auto is_global = [&] { return certificate.error - certificate.lower_bound <= negligible; };
  certificate.lower_bound = LowerBound(graph);
  if (!is_global()) {
    // A point that is not quite a minimum gives a worse bound, but what the minimum next to it
    // gives is as true.
    PoseGraph<Pose> polished = graph;
    OptimizerOptions options;
    options.method = Method::kGaussNewton;
    options.max_iterations = kPolishingSteps;
    options.relative_decrease = options.absolute_decrease = kPolished;
    Optimizer<Pose>(options).Optimize(&polished);
    certificate.lower_bound = std::max(certificate.lower_bound, LowerBound(polished));
  }
  if (is_global()) {
    certificate.kind = Kind::kGlobal;
  } else if (certificate.lower_bound > 0.0) {
    certificate.kind = Kind::kBounded;
  }
  return certificate;
}

#define LOOPGRID_INSTANTIATE(Pose) \
  template OptimalityCertificate CertifyOptimality(const PoseGraph<Pose>&);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
