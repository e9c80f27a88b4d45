#include "backend/global/quadratic_minorant.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "backend/graph/constraint_error.h"
#include "tests/support/noisy_graphs.h"
#include "tests/support/poses.h"

namespace loopgrid {
namespace {

template <typename Pose>
class QuadraticMinorantTest : public ::testing::Test {};
TYPED_TEST_SUITE(QuadraticMinorantTest, test_support::AllPoses, test_support::PoseName);

/// Its value, but for the constant.
template <typename Pose>
double Value(const QuadraticMinorant<Pose>& minorant, const Pose& from, const Pose& to) {
  const Pose T = from.Inverse() * to;
  return minorant.alpha * T.translation().squaredNorm() + 2.0 * minorant.beta.dot(T.translation()) +
         2.0 * minorant.M.cwiseProduct(T.rotation()).sum();
}

/// Two nodes and a constraint that does not quite fit them.
template <typename Pose>
PoseGraph<Pose> OneConstraint(double largest_shift, double largest_angle, std::mt19937* random) {
  PoseGraph<Pose> graph;
  graph.poses = {test_support::RandomPose<Pose>(random, 3.0), Pose()};
  Constraint<Pose> constraint;
  constraint.from = 0;
  constraint.to = 1;
  constraint.T_from_to = test_support::RandomPose<Pose>(random, 3.0);
  constraint.information =
      test_support::RandomInformationAbove<typename Constraint<Pose>::Information>(0.1, random);
  graph.constraints = {constraint};
  std::uniform_real_distribution<double> angle(-largest_angle, largest_angle);
  graph.poses[1] = graph.poses[0] * constraint.T_from_to *
                   test_support::PoseWithAngle<Pose>(
                       test_support::RandomVector<typename Pose::Point>(random, largest_shift),
                       angle(*random), random);
  return graph;
}

/// Without correlation of translation and rotation.
template <typename Pose>
void Decorrelate(PoseGraph<Pose>* graph) {
  constexpr int kDim = QuadraticMinorant<Pose>::kDim;
  auto& information = graph->constraints[0].information;
  information.template topRightCorner<kDim, Pose::kDof - kDim>().setZero();
  information.template bottomLeftCorner<Pose::kDof - kDim, kDim>().setZero();
}

TYPED_TEST(QuadraticMinorantTest, IsNowhereAboveTheError) {
  using Pose = TypeParam;
  for (unsigned seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    PoseGraph<Pose> graph = OneConstraint<Pose>(1.0, seed % 2 == 0 ? 0.5 : 3.14, &random);
    if (seed % 3 == 0) Decorrelate(&graph);
    const double here = Chi2(graph, graph.constraints[0]);
    for (auto kind : {MinorantOf3dRotation::kExact, MinorantOf3dRotation::kConvex}) {
      const QuadraticMinorant<Pose> minorant = Minorize(graph, graph.constraints[0], kind);
      EXPECT_GE(minorant.slack, 0.0);
      const double constant =
          here - minorant.slack - Value(minorant, graph.poses[0], graph.poses[1]);
      PoseGraph<Pose> moved = graph;
      for (int trial = 0; trial < 200; ++trial) {
        moved.poses[1] =
            trial % 2 == 0 ? test_support::RandomPose<Pose>(&random, 6.0)
                           : graph.poses[1].Boxplus(
                                 test_support::RandomVector<typename Pose::Tangent>(&random, 0.3));
        const double error = Chi2(moved, moved.constraints[0]);
        EXPECT_LE(constant + Value(minorant, moved.poses[0], moved.poses[1]),
                  error + 1e-9 * (error + here))
            << "seed " << seed << ", trial " << trial;
      }
    }
  }
}

TYPED_TEST(QuadraticMinorantTest, TouchesTheErrorWithoutCorrelations) {
  using Pose = TypeParam;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    PoseGraph<Pose> graph = OneConstraint<Pose>(1.0, 3.0, &random);
    Decorrelate(&graph);
    for (auto kind : {MinorantOf3dRotation::kExact, MinorantOf3dRotation::kConvex}) {
      const QuadraticMinorant<Pose> minorant = Minorize(graph, graph.constraints[0], kind);
      EXPECT_NEAR(minorant.slack, 0.0, 1e-12);
      for (int k = 0; k < Pose::kDof; ++k) {
        constexpr double kStep = 1e-6;
        const auto change = [&](const auto& function) {
          PoseGraph<Pose> moved = graph;
          typename Pose::Tangent d = Pose::Tangent::Unit(k) * kStep;
          moved.poses[1] = graph.poses[1].Boxplus(d);
          const double ahead = function(moved);
          moved.poses[1] = graph.poses[1].Boxplus(-d);
          return (ahead - function(moved)) / (2.0 * kStep);
        };
        const double slope =
            change([](const PoseGraph<Pose>& g) { return Chi2(g, g.constraints[0]); });
        EXPECT_NEAR(slope, change([&](const PoseGraph<Pose>& g) {
                      return Value(minorant, g.poses[0], g.poses[1]);
                    }),
                    1e-5 * (1.0 + std::abs(slope)))
            << "seed " << seed;
      }
    }
  }
}

TYPED_TEST(QuadraticMinorantTest, CorrelationsCostLittleWhereErrorsAreSmall) {
  using Pose = TypeParam;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    PoseGraph<Pose> graph = OneConstraint<Pose>(1e-3, 1e-3, &random);
    const double error = Chi2(graph, graph.constraints[0]);
    EXPECT_LE(Minorize(graph, graph.constraints[0], MinorantOf3dRotation::kExact).slack,
              1e-2 * error)
        << "seed " << seed;
  }
}

TYPED_TEST(QuadraticMinorantTest, OfAnObservationTouchesAndIsNowhereAbove) {
  using Pose = TypeParam;
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    PoseGraph<Pose> graph = test_support::RandomKnownGraph<Pose>(2, 0, 1, 1.0, &random);
    const auto& observation = graph.observations[0];
    const QuadraticMinorant<Pose> minorant = Minorize(graph, observation);
    EXPECT_EQ(minorant.slack, 0.0);
    const auto below = [&] {
      const typename Pose::Point r =
          graph.poses[static_cast<std::size_t>(observation.node)].Inverse() * graph.landmarks[0];
      return Chi2(graph, observation) - minorant.alpha * r.squaredNorm() -
             2.0 * minorant.beta.dot(r);
    };
    const double here = below();
    for (int trial = 0; trial < 100; ++trial) {
      graph.landmarks[0] = test_support::RandomVector<typename Pose::Point>(&random, 8.0);
      EXPECT_GE(below(), here - 1e-9 * (1.0 + std::abs(here))) << "seed " << seed;
    }
  }
}

TEST(QuadraticMinorantTest, HasNoRotationNextToHalfATurn) {
  PoseGraph<SE2> graph;
  graph.poses = {SE2(), SE2(1.0, 0.0, -std::numbers::pi)};
  graph.constraints = {{0, 1, SE2()}};
  const auto minorant = Minorize(graph, graph.constraints[0], MinorantOf3dRotation::kExact);
  EXPECT_EQ(minorant.alpha, 1.0);
  EXPECT_TRUE(minorant.M.isZero(0.0));
  EXPECT_DOUBLE_EQ(minorant.slack, std::numbers::pi * std::numbers::pi);
}

}  // namespace
}  // namespace loopgrid
