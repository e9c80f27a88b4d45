#include "tests/support/ceres_optimizer.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cstddef>

#include "backend/graph/constraint_error.h"

namespace loopgrid::test_support {
namespace {

// A pose in the form that Ceres stores.
template <typename Pose>
struct Ambient;

template <>
struct Ambient<SE2> {
  static constexpr int kSize = 3;
  static SE2 Read(const double* x) { return SE2(x[0], x[1], x[2]); }
  static void Write(const SE2& pose, double* x) {
    x[0] = pose.x();
    x[1] = pose.y();
    x[2] = pose.theta();
  }
};

template <>
struct Ambient<SE3> {
  static constexpr int kSize = 7;
  static SE3 Read(const double* x) {
    return SE3(Eigen::Vector3d(x), Eigen::Quaterniond(x[6], x[3], x[4], x[5]));
  }
  static void Write(const SE3& pose, double* x) {
    Eigen::Map<Eigen::Vector3d>(x, 3) = pose.translation();
    Eigen::Map<Eigen::Vector4d>(x + 3) = pose.quaternion().coeffs();
  }
};

template <typename Pose>
using AmbientJacobian = Eigen::Matrix<double, Pose::kDof, Ambient<Pose>::kSize, Eigen::RowMajor>;

/// Ceres multiplies the Jacobians of residuals by that of Plus. Our Jacobians are already for local
/// motions: they are in the first columns, and the Jacobian of Plus selects those columns.
template <typename Pose>
class PoseManifold : public ceres::Manifold {
 public:
  static constexpr int kDof = Pose::kDof;
  static constexpr int kSize = Ambient<Pose>::kSize;

  int AmbientSize() const override { return kSize; }
  int TangentSize() const override { return kDof; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const typename Pose::Tangent d = Eigen::Map<const typename Pose::Tangent>(delta);
    Ambient<Pose>::Write(Ambient<Pose>::Read(x).Boxplus(d), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kSize, kDof, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<typename Pose::Tangent>(y_minus_x, kDof) =
        Ambient<Pose>::Read(y).Boxminus(Ambient<Pose>::Read(x));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<AmbientJacobian<Pose>>(jacobian).setIdentity();
    return true;
  }
};

template <typename Pose>
class ConstraintCost
    : public ceres::SizedCostFunction<Pose::kDof, Ambient<Pose>::kSize, Ambient<Pose>::kSize> {
 public:
  explicit ConstraintCost(const Constraint<Pose>& constraint)
      : T_from_to_(constraint.T_from_to), root_(constraint.information.llt().matrixU()) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    constexpr int kDof = Pose::kDof;
    const Pose from = Ambient<Pose>::Read(parameters[0]);
    const Pose to = Ambient<Pose>::Read(parameters[1]);
    Eigen::Map<typename Pose::Tangent> residual(residuals, kDof);
    if (jacobians == nullptr) {
      residual = root_ * ConstraintError(from, to, T_from_to_);
      return true;
    }
    const LinearizedConstraint<Pose> linear = Linearize(from, to, T_from_to_);
    residual = root_ * linear.error;
    const auto fill = [this](const auto& J, double* jacobian) {
      if (jacobian == nullptr) return;
      Eigen::Map<AmbientJacobian<Pose>> filled(jacobian);
      filled.setZero();
      filled.template leftCols<kDof>() = root_ * J;
    };
    fill(linear.J_from, jacobians[0]);
    fill(linear.J_to, jacobians[1]);
    return true;
  }

 private:
  Pose T_from_to_;
  typename Constraint<Pose>::Information root_;
};

ceres::Solver::Options SolverOptions(const CeresSettings& settings) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type =
      settings.cx_sparse ? ceres::CX_SPARSE : ceres::SUITE_SPARSE;
  options.trust_region_strategy_type =
      settings.dog_leg ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
  options.initial_trust_region_radius = settings.trust_radius;
  options.max_trust_region_radius = std::max(1e16, settings.trust_radius);
  options.function_tolerance = settings.function_tolerance;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 0.0;
  options.max_num_iterations = settings.max_iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

std::vector<CeresSettings> AllCeresSettings() {
  return {{"lm"},
          {"lm-wide", false, false, 1e16},
          {"dogleg", true},
          {"lm-cxsparse", false, true},
          {"lm-wide-cxsparse", false, true, 1e16}};
}

template <typename Pose>
CeresResult OptimizeWithCeres(const CeresSettings& settings, PoseGraph<Pose>* graph) {
  std::vector<std::array<double, Ambient<Pose>::kSize>> states(graph->poses.size());
  PoseManifold<Pose> manifold;
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  for (std::size_t i = 0; i < states.size(); ++i) {
    Ambient<Pose>::Write(graph->poses[i], states[i].data());
    problem.AddParameterBlock(states[i].data(), Ambient<Pose>::kSize, &manifold);
  }
  for (const Constraint<Pose>& constraint : graph->constraints) {
    problem.AddResidualBlock(new ConstraintCost<Pose>(constraint), nullptr,
                             states[static_cast<std::size_t>(constraint.from)].data(),
                             states[static_cast<std::size_t>(constraint.to)].data());
  }
  for (int node : HeldNodes(*graph, ConnectedComponents(*graph))) {
    problem.SetParameterBlockConstant(states[static_cast<std::size_t>(node)].data());
  }
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(settings), &problem, &summary);
  for (std::size_t i = 0; i < states.size(); ++i) {
    graph->poses[i] = Ambient<Pose>::Read(states[i].data());
  }
  return {2.0 * summary.final_cost, static_cast<int>(summary.iterations.size()) - 1};
}

template CeresResult OptimizeWithCeres(const CeresSettings&, PoseGraph<SE2>*);
template CeresResult OptimizeWithCeres(const CeresSettings&, PoseGraph<SE3>*);

}  // namespace loopgrid::test_support
