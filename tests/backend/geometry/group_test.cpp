// What holds for every group of poses.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>

#include "tests/support/poses.h"

namespace loopgrid {
namespace {

using test_support::Distance;
using test_support::Homogeneous;
using test_support::PoseWithAngle;
using test_support::RandomPose;
using test_support::RandomVector;

constexpr double kGroupPi = std::numbers::pi;

template <typename Pose>
class GroupTest : public ::testing::Test {
 protected:
  using Point = typename Pose::Point;
  static constexpr int kPoint = Point::RowsAtCompileTime;
  static constexpr int kSeed = 1;

  std::mt19937 random_{kSeed};
};

TYPED_TEST_SUITE(GroupTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(GroupTest, AgreesWithHomogeneousMatrices) {
  using Pose = TypeParam;
  for (int i = 0; i < 200; ++i) {
    const Pose a = RandomPose<Pose>(&this->random_, 100.0);
    const Pose b = RandomPose<Pose>(&this->random_, 100.0);
    const auto p = RandomVector<typename Pose::Point>(&this->random_, 100.0);
    EXPECT_TRUE(Homogeneous(a * b).isApprox(Homogeneous(a) * Homogeneous(b), 1e-14));
    EXPECT_TRUE(Homogeneous(a.Inverse()).isApprox(Homogeneous(a).inverse(), 1e-12));
    const Eigen::VectorXd moved = Homogeneous(a) * p.homogeneous();
    EXPECT_TRUE((a * p).isApprox(moved.head<TestFixture::kPoint>(), 1e-13));
  }
}

TYPED_TEST(GroupTest, RotationsAreOrthonormalAndRightHanded) {
  for (int i = 0; i < 100; ++i) {
    const auto R = RandomPose<TypeParam>(&this->random_).rotation().eval();
    EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
    EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
  }
}

TYPED_TEST(GroupTest, IsAGroupThatActsOnPoints) {
  using Pose = TypeParam;
  for (int i = 0; i < 200; ++i) {
    const Pose a = RandomPose<Pose>(&this->random_);
    const Pose b = RandomPose<Pose>(&this->random_);
    const Pose c = RandomPose<Pose>(&this->random_);
    const auto p = RandomVector<typename Pose::Point>(&this->random_, 20.0);
    EXPECT_LE(Distance((a * b) * c, a * (b * c)), 1e-13);
    EXPECT_LE(Distance(a * a.Inverse(), Pose()), 1e-13);
    EXPECT_LE(Distance(a.Inverse() * a, Pose()), 1e-13);
    EXPECT_LE(Distance((a * b).Inverse(), b.Inverse() * a.Inverse()), 1e-13);
    EXPECT_LE(Distance(a * Pose(), a), 1e-14);
    EXPECT_LE(((a * b) * p - a * (b * p)).norm(), 1e-13);
    EXPECT_LE((a.Inverse() * (a * p) - p).norm(), 1e-13);
  }
}

TYPED_TEST(GroupTest, CoordinatesMakeThePoseAgain) {
  for (double angle : {0.0, 1e-9, -1.0, 3.0, -kGroupPi + 1e-3}) {
    const TypeParam pose =
        PoseWithAngle<TypeParam>(TestFixture::Point::Constant(-2.5), angle, &this->random_);
    EXPECT_LE(Distance(TypeParam(pose.coordinates()), pose), 1e-12) << angle;
  }
}

TYPED_TEST(GroupTest, BoxminusUndoesBoxplus) {
  using Pose = TypeParam;
  for (int i = 0; i < 200; ++i) {
    const Pose a = RandomPose<Pose>(&this->random_, 100.0);
    const Pose b = RandomPose<Pose>(&this->random_, 100.0);
    const typename Pose::Tangent d = b.coordinates();
    EXPECT_TRUE(a.Boxplus(d).Boxminus(a).isApprox(d, 1e-12));
    EXPECT_LE(Distance(a.Boxplus(b.Boxminus(a)), b), 1e-11);
    EXPECT_TRUE(a.Boxminus(a).isZero(1e-12));
  }
}

TYPED_TEST(GroupTest, LogUndoesExpFromNothingToHalfATurn) {
  using Twist = typename TypeParam::Tangent;
  for (double angle : {0.0, 1e-9, 1e-7, 1e-5, 9.9e-5, 1.01e-4, 9e-3, 1.1e-2, 0.5, 2.0, 3.0,
                       kGroupPi - 1e-4, kGroupPi - 1e-9}) {
    for (double sign : {1.0, -1.0}) {
      Twist twist = RandomVector<Twist>(&this->random_);
      auto omega = twist.template tail<TypeParam::kDof - TestFixture::kPoint>();
      omega *= sign * angle / omega.norm();
      EXPECT_TRUE(TypeParam::Exp(twist).Log().isApprox(twist, 1e-13)) << sign * angle;
    }
  }
}

TYPED_TEST(GroupTest, LogOfHalfATurnIsOneOfItsTwoTwists) {
  for (double angle : {kGroupPi, -kGroupPi}) {
    const TypeParam pose =
        PoseWithAngle<TypeParam>(TestFixture::Point::Constant(2.0), angle, &this->random_);
    EXPECT_LE(Distance(TypeParam::Exp(pose.Log()), pose), 1e-14);
  }
}

TYPED_TEST(GroupTest, ExpIsTheMatrixExponential) {
  using Twist = typename TypeParam::Tangent;
  for (double angle : {1e-6, 1e-4, 2e-4, 1e-3, 1e-2, 1.0, 3.0}) {
    Twist twist = RandomVector<Twist>(&this->random_);
    auto omega = twist.template tail<TypeParam::kDof - TestFixture::kPoint>();
    omega *= angle / omega.norm();
    const int size = TestFixture::kPoint + 1;
    Eigen::MatrixXd X = Eigen::MatrixXd::Zero(size, size);
    X.topRightCorner(size - 1, 1) = twist.template head<TestFixture::kPoint>();
    if constexpr (TypeParam::kDof == 3) {
      X(1, 0) = twist.z();
      X(0, 1) = -twist.z();
    } else {
      X.template topLeftCorner<3, 3>() = Skew(twist.template tail<3>());
    }
    Eigen::MatrixXd power = Eigen::MatrixXd::Identity(size, size);
    Eigen::MatrixXd term = power;
    for (int k = 1; k < 40; ++k) {
      term *= X / k;
      power += term;
    }
    EXPECT_LE((Homogeneous(TypeParam::Exp(twist)) - power).norm(), 1e-14) << angle;
  }
}

TYPED_TEST(GroupTest, AdjointMovesSmallMotionsBetweenFrames) {
  using Twist = typename TypeParam::Tangent;
  for (int i = 0; i < 50; ++i) {
    const TypeParam T = RandomPose<TypeParam>(&this->random_);
    const Twist d = RandomVector<Twist>(&this->random_, 1e-5);
    // Central differences: what is of second order cancels.
    const Twist moved = (T * TypeParam(d) * T.Inverse()).coordinates() -
                        (T * TypeParam(Twist(-d)) * T.Inverse()).coordinates();
    EXPECT_TRUE((T.Adjoint() * d).isApprox(0.5 * moved, 1e-8)) << "case " << i;
  }
}

TYPED_TEST(GroupTest, AdjointOfAProductIsTheProductOfAdjoints) {
  const auto a = RandomPose<TypeParam>(&this->random_);
  const auto b = RandomPose<TypeParam>(&this->random_);
  EXPECT_TRUE((a * b).Adjoint().isApprox(a.Adjoint() * b.Adjoint(), 1e-13));
  EXPECT_TRUE((a.Adjoint() * a.Inverse().Adjoint()).isIdentity(1e-11));
}

TYPED_TEST(GroupTest, StaysExactFarAway) {
  const auto far = PoseWithAngle<TypeParam>(TestFixture::Point::Constant(1e6), 3.0, &this->random_);
  const auto near = RandomPose<TypeParam>(&this->random_, 1.0);
  // A double has 1e-10 m left at this distance.
  EXPECT_LE(Distance(far.Inverse() * far, TypeParam()), 3e-9);
  EXPECT_LE(Distance(far.Inverse() * (far * near), near), 3e-9);
  EXPECT_LE((far.Boxplus(near.coordinates()).Boxminus(far) - near.coordinates()).norm(), 3e-9);
}

TYPED_TEST(GroupTest, ManyProductsDoNotDriftOffTheGroup) {
  const auto step = PoseWithAngle<TypeParam>(TestFixture::Point::Zero(), 0.1, &this->random_);
  TypeParam pose;
  for (int i = 0; i < 100000; ++i) pose = pose * step;
  const auto R = pose.rotation().eval();
  EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
  // A hundred thousand tenths of a radian; rounding adds up to no more than their number.
  const double turned = 1e4 - 2.0 * kGroupPi * std::round(1e4 / (2.0 * kGroupPi));
  EXPECT_NEAR(R.trace(),
              TestFixture::kPoint == 2 ? 2.0 * std::cos(turned) : 1.0 + 2.0 * std::cos(turned),
              1e-9);
}

TYPED_TEST(GroupTest, SaysWhetherItIsFinite) {
  typename TypeParam::Tangent coordinates = TypeParam::Tangent::Constant(0.1);
  EXPECT_TRUE(TypeParam(coordinates).IsFinite());
  for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (int i = 0; i < TypeParam::kDof; ++i) {
      coordinates.setConstant(0.1);
      coordinates(i) = bad;
      EXPECT_FALSE(TypeParam(coordinates).IsFinite()) << bad << " at " << i;
    }
  }
}

TEST(SE3, HasTheQuaternionWithPositiveW) {
  const Eigen::Quaterniond q(0.5, 0.1, -0.7, 0.3);
  const Eigen::Quaterniond opposite(-0.5, -0.1, 0.7, -0.3);
  const SE3 a(Eigen::Vector3d::Ones(), q);
  const SE3 b(Eigen::Vector3d::Ones(), opposite);
  EXPECT_EQ(a.coordinates(), b.coordinates());
  EXPECT_GT(a.quaternion().w(), 0.0);
  const SE3 turn(Eigen::Vector3d::Zero(),
                 Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitX())));
  EXPECT_GE((turn * turn).quaternion().w(), 0.0);  // 4 radians: the other way round is shorter
  EXPECT_NEAR(turn.Boxplus(turn.coordinates()).Log()(3), 4.0 - 2.0 * kGroupPi, 1e-14);
}

TEST(SE3, NormalizesItsQuaternion) {
  for (double scale : {1e-3, 0.999, 1e5}) {
    const Eigen::Quaterniond q(scale * Eigen::Vector4d(0.3, -0.4, 0.1, 0.2));
    const SE3 pose(Eigen::Vector3d::Zero(), q);
    EXPECT_NEAR(pose.quaternion().norm(), 1.0, 1e-15);
    EXPECT_TRUE(pose.rotation().isApprox(q.normalized().toRotationMatrix(), 1e-14));
  }
}

TEST(SE3, ATangentWithAVectorPartTooLongIsHalfATurn) {
  SE3::Tangent d = SE3::Tangent::Zero();
  d.tail<3>() = Eigen::Vector3d(0.0, 3.0, -4.0);
  const Eigen::Vector3d axis(0.0, 0.6, -0.8);
  EXPECT_TRUE(
      SE3(d).rotation().isApprox(Eigen::AngleAxisd(kGroupPi, axis).toRotationMatrix(), 1e-14));
  EXPECT_NEAR(SE3(d).quaternion().norm(), 1.0, 1e-15);
  d.tail<3>() = axis;  // just not too long
  EXPECT_NEAR(SE3(d).quaternion().norm(), 1.0, 1e-15);
}

TEST(Skew, IsTheCrossProduct) {
  const Eigen::Vector3d a(1.0, -2.0, 3.0);
  const Eigen::Vector3d b(0.5, 4.0, -1.0);
  EXPECT_EQ(Skew(a) * b, a.cross(b));
}

}  // namespace
}  // namespace loopgrid
