#include "backend/graph/parametrization.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "backend/geometry/euler.h"
#include "tests/support/poses.h"

namespace loopgrid {
namespace {

using test_support::Distance;
using test_support::PoseWithAngle;
using test_support::RandomPose;
using test_support::RandomVector;

constexpr double kHalfTurn = std::numbers::pi;
constexpr Parametrization kAll[] = {Parametrization::kManifold, Parametrization::kExponential,
                                    Parametrization::kEuler};

template <typename Pose>
class ParametrizationTest : public ::testing::Test {
 protected:
  using Point = typename Pose::Point;

  /// The derivative of `error` by the k-th coordinate of an increment, by central differences whose
  /// leading errors cancel (Richardson).
  template <typename Function>
  static auto Derivative(const Function& error, int k) {
    const auto slope = [&](double step) {
      typename Pose::Tangent d = Pose::Tangent::Zero();
      d(k) = step;
      auto difference = error(d);
      d(k) = -step;
      difference -= error(d);
      // An angle may have passed half a turn in between.
      if (difference.size() == 3 && Pose::kDof == 3) difference(2) = NormalizeAngle(difference(2));
      return (difference / (2.0 * step)).eval();
    };
    return ((4.0 * slope(5e-5) - slope(1e-4)) / 3.0).eval();
  }

  /// The pose that `measured` and an error with this angle make of `from`.
  Pose PoseWithError(const Pose& from, const Pose& measured, double angle) {
    return from * measured *
           PoseWithAngle<Pose>(RandomVector<Point>(&random_, 3.0), angle, &random_);
  }

  std::mt19937 random_{12};
};

TYPED_TEST_SUITE(ParametrizationTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(ParametrizationTest, JacobiansOfConstraintsAgreeWithNumericDerivatives) {
  using Pose = TypeParam;
  for (const Parametrization parametrization : kAll) {
    for (double angle : {0.0, 1e-9, 1e-3, 1.0, -2.0, kHalfTurn - 0.01, -kHalfTurn + 0.01}) {
      for (double reach : {1.0, 20.0, 1e4}) {
        SCOPED_TRACE(::testing::Message() << "parametrization " << static_cast<int>(parametrization)
                                          << ", error of " << angle << ", at " << reach << " m");
        const auto from = RandomPose<Pose>(&this->random_, reach);
        const auto measured = RandomPose<Pose>(&this->random_, 5.0);
        const auto to = this->PoseWithError(from, measured, angle);
        const auto linear = Linearize(from, to, measured, parametrization);
        EXPECT_TRUE(
            linear.error.isApprox(ConstraintError(from, to, measured, parametrization), 1e-12));
        const double tolerance = 1e-7 + 1e-11 * reach;
        for (int k = 0; k < Pose::kDof; ++k) {
          const auto by_from = this->Derivative(
              [&](const auto& d) {
                return ConstraintError(Increment(from, d, parametrization), to, measured,
                                       parametrization);
              },
              k);
          const auto by_to = this->Derivative(
              [&](const auto& d) {
                return ConstraintError(from, Increment(to, d, parametrization), measured,
                                       parametrization);
              },
              k);
          EXPECT_LE((by_from - linear.J_from.col(k)).norm(), tolerance * linear.J_from.norm()) << k;
          EXPECT_LE((by_to - linear.J_to.col(k)).norm(), tolerance * linear.J_to.norm()) << k;
        }
      }
    }
  }
}

TYPED_TEST(ParametrizationTest, JacobiansOfObservationsAgreeWithNumericDerivatives) {
  using Pose = TypeParam;
  using Landmark = typename Pose::Point;
  for (const Parametrization parametrization : kAll) {
    for (double reach : {0.0, 1.0, 20.0, 1e4}) {
      const auto node = RandomPose<Pose>(&this->random_, reach);
      const auto p_node = RandomVector<Landmark>(&this->random_, 5.0);
      const Landmark landmark =
          node * Landmark(p_node + RandomVector<Landmark>(&this->random_, 3.0));
      const auto linear = Linearize(node, landmark, p_node, parametrization);
      const double tolerance = 1e-9 + 1e-11 * reach;
      for (int k = 0; k < Pose::kDof; ++k) {
        const Landmark by_node = this->Derivative(
            [&](const auto& d) -> Landmark {
              const Pose moved = Increment(node, d, parametrization);
              return ObservationError(moved, landmark, p_node);
            },
            k);
        EXPECT_LE((by_node - linear.J_node.col(k)).norm(), tolerance * linear.J_node.norm()) << k;
      }
      for (int k = 0; k < landmark.size(); ++k) {
        // The error is linear in the landmark.
        const Landmark moved = landmark + Landmark::Unit(k);
        const Landmark by_landmark = ObservationError(node, moved, p_node) - linear.error;
        EXPECT_LE((by_landmark - linear.J_landmark.col(k)).norm(), tolerance) << k;
      }
    }
  }
}

TYPED_TEST(ParametrizationTest, IncrementsOfZeroChangeNothing) {
  const auto pose = RandomPose<TypeParam>(&this->random_);
  for (const Parametrization parametrization : kAll) {
    const auto same = Increment<TypeParam>(pose, TypeParam::Tangent::Zero(), parametrization);
    EXPECT_LE(Distance(same, pose), 1e-13);
  }
}

TYPED_TEST(ParametrizationTest, IncrementsAreWhatTheyAreCalled) {
  using Tangent = typename TypeParam::Tangent;
  const auto pose = RandomPose<TypeParam>(&this->random_);
  const Tangent d = RandomVector<Tangent>(&this->random_, 0.3);
  EXPECT_LE(Distance(Increment(pose, d, Parametrization::kManifold), pose.Boxplus(d)), 0.0);
  EXPECT_LE(Distance(Increment(pose, d, Parametrization::kExponential), pose * TypeParam::Exp(d)),
            0.0);
  const TypeParam added = Increment(pose, d, Parametrization::kEuler);
  const auto shift = d.template head<TestFixture::Point::RowsAtCompileTime>();
  EXPECT_TRUE((added.translation() - pose.translation()).isApprox(shift, 1e-12));
  if constexpr (TypeParam::kDof == 3) {
    EXPECT_NEAR(added.theta(), NormalizeAngle(pose.theta() + d.z()), 1e-15);
  } else {
    const Eigen::Vector3d angles = RollPitchYaw(pose.quaternion()) + d.template tail<3>();
    EXPECT_TRUE(added.rotation().isApprox(FromRollPitchYaw(angles).toRotationMatrix(), 1e-13));
  }
}

TYPED_TEST(ParametrizationTest, SmallErrorsAreTheSameInAll) {
  for (int i = 0; i < 20; ++i) {
    const auto from = RandomPose<TypeParam>(&this->random_);
    const auto measured = RandomPose<TypeParam>(&this->random_);
    const auto to = this->PoseWithError(from, measured, 1e-5);
    const auto expected = ConstraintError(from, to, measured);
    for (const Parametrization parametrization : kAll) {
      const auto error = ConstraintError(from, to, measured, parametrization);
      EXPECT_LE((error - expected).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace loopgrid
