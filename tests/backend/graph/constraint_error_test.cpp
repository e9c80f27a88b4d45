#include "backend/graph/constraint_error.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/poses.h"

namespace loopgrid {
namespace {

using test_support::Homogeneous;
using test_support::RandomPose;
using test_support::RandomVector;

template <typename Pose>
class ConstraintErrorTest : public ::testing::Test {
 protected:
  std::mt19937 random_{11};
};

TYPED_TEST_SUITE(ConstraintErrorTest, test_support::AllPoses, test_support::PoseName);

/// The error as g2o defines it, by way of homogeneous matrices.
SE2::Tangent StraightforwardError(const SE2& from, const SE2& to, const SE2& measured) {
  const Eigen::Matrix3d E =
      Homogeneous(measured).inverse() * Homogeneous(from).inverse() * Homogeneous(to);
  return {E(0, 2), E(1, 2), std::atan2(E(1, 0), E(0, 0))};
}

SE3::Tangent StraightforwardError(const SE3& from, const SE3& to, const SE3& measured) {
  const Eigen::Matrix4d E =
      Homogeneous(measured).inverse() * Homogeneous(from).inverse() * Homogeneous(to);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(E.topLeftCorner<3, 3>()));  // angle in [0, pi]
  SE3::Tangent error;
  error << E.topRightCorner<3, 1>(), std::sin(0.5 * turn.angle()) * turn.axis();
  return error;
}

TYPED_TEST(ConstraintErrorTest, IsTheDisplacementSeenFromTheMeasuredPose) {
  for (int i = 0; i < 200; ++i) {
    const auto from = RandomPose<TypeParam>(&this->random_);
    const auto to = RandomPose<TypeParam>(&this->random_);
    const auto measured = RandomPose<TypeParam>(&this->random_);
    const auto error = ConstraintError(from, to, measured);
    EXPECT_TRUE(error.isApprox(StraightforwardError(from, to, measured), 1e-9)) << "case " << i;
    EXPECT_TRUE(Linearize(from, to, measured).error.isApprox(error, 1e-15)) << "case " << i;
  }
}

TYPED_TEST(ConstraintErrorTest, IsZeroWhereTheMeasurementIsRight) {
  for (double reach : {1.0, 100.0, 1e6}) {
    const auto from = RandomPose<TypeParam>(&this->random_, reach);
    const auto measured = RandomPose<TypeParam>(&this->random_, 1.0);
    EXPECT_TRUE(ConstraintError(from, from * measured, measured).isZero(1e-14 * reach)) << reach;
  }
}

TYPED_TEST(ConstraintErrorTest, OfAnObservationIsTheLandmarkSeenFromTheNode) {
  using Point = typename TypeParam::Point;
  const auto node = RandomPose<TypeParam>(&this->random_);
  const auto measured = RandomVector<Point>(&this->random_, 3.0);
  const auto offset = RandomVector<Point>(&this->random_, 0.1);
  const Point landmark = node * Point(measured + offset);
  EXPECT_TRUE(ObservationError(node, landmark, measured).isApprox(offset, 1e-12));
  EXPECT_TRUE(Linearize(node, landmark, measured).error.isApprox(offset, 1e-12));
}

// What makes a choice of the held node a mere choice: see Marginals::RelativeTo.
TYPED_TEST(ConstraintErrorTest, DoesNotChangeWhenBothNodesMoveTogether) {
  for (int i = 0; i < 50; ++i) {
    const auto from = RandomPose<TypeParam>(&this->random_);
    const auto to = RandomPose<TypeParam>(&this->random_);
    const auto linear = Linearize(from, to, RandomPose<TypeParam>(&this->random_));
    const auto change =
        (linear.J_from * from.Inverse().Adjoint() + linear.J_to * to.Inverse().Adjoint()).eval();
    EXPECT_TRUE(change.isZero(1e-11)) << "case " << i;
  }
}

TYPED_TEST(ConstraintErrorTest, Chi2WeighsItByTheInformation) {
  using Pose = TypeParam;
  using Tangent = typename Pose::Tangent;
  PoseGraph<Pose> graph;
  for (int i = 0; i < 3; ++i) graph.poses.push_back(RandomPose<Pose>(&this->random_));
  // Constraints with an error of 0.1 i in coordinate i, and information 1, 2, 3 ...
  const Tangent error = Tangent::LinSpaced(0.0, 0.1 * (Pose::kDof - 1));
  const Tangent weights = Tangent::LinSpaced(1.0, Pose::kDof);
  for (int from = 0; from < 2; ++from) {
    Constraint<Pose> c{from, from + 1, {}, weights.asDiagonal()};
    const auto i = static_cast<std::size_t>(from);
    // What is seen is the measured pose moved by the error.
    c.T_from_to = graph.poses[i].Inverse() * graph.poses[i + 1] * Pose(error).Inverse();
    c.information(0, 1) = c.information(1, 0) = 0.5;
    graph.constraints.push_back(c);
  }
  const double expected = error.dot(weights.cwiseProduct(error)) + error(0) * error(1);
  EXPECT_NEAR(Chi2(graph, graph.constraints[1]), expected, 1e-12);
  LandmarkObservation<Pose> observation;
  observation.node = 2;
  observation.information *= 4.0;
  observation.p_node.setConstant(1.5);
  graph.landmarks.push_back(graph.poses[2] * Pose::Point::Constant(2.0).eval());
  graph.observations.push_back(observation);
  const double seen = static_cast<double>(observation.p_node.size());
  EXPECT_NEAR(Chi2(graph, observation), seen, 1e-12);
  EXPECT_NEAR(TotalChi2(graph), 2.0 * expected + seen, 1e-12);
}

}  // namespace
}  // namespace loopgrid
