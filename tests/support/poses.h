#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>
#include <string>

#include "backend/geometry/se2.h"
#include "backend/geometry/se3.h"

namespace loopgrid::test_support {

/// The types and names of a typed suite over all kinds of poses.
using AllPoses = ::testing::Types<SE2, SE3>;

struct PoseName {
  template <typename Pose>
  static std::string GetName(int) {
    return Pose::kDof == 3 ? "SE2" : "SE3";
  }
};

/// A vector of numbers in [-reach, reach], drawn one after the other.
template <typename Vector>
Vector RandomVector(std::mt19937* random, double reach = 1.0) {
  std::uniform_real_distribution<double> value(-reach, reach);
  Vector vector;
  for (int i = 0; i < vector.size(); ++i) vector(i) = value(*random);
  return vector;
}

/// A translation and then a rotation by `angle`: in space, about a random axis.
template <typename Pose>
Pose PoseWithAngle(const typename Pose::Point& translation, double angle, std::mt19937* random) {
  if constexpr (Pose::kDof == 3) {
    return Pose(translation.x(), translation.y(), angle);
  } else {
    const Eigen::Vector3d axis = RandomVector<Eigen::Vector3d>(random).normalized();
    return Pose(translation, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)));
  }
}

template <typename Pose>
Pose RandomPose(std::mt19937* random, double reach = 20.0) {
  const auto translation = RandomVector<typename Pose::Point>(random, reach);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  return PoseWithAngle<Pose>(translation, angle(*random), random);
}

/// The pose as a matrix that acts on homogeneous coordinates.
template <typename Pose>
Eigen::MatrixXd Homogeneous(const Pose& pose) {
  constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(kPoint + 1, kPoint + 1);
  matrix.topLeftCorner(kPoint, kPoint) = pose.rotation();
  matrix.topRightCorner(kPoint, 1) = pose.translation();
  return matrix;
}

/// A distance of two poses: the larger of metres and radians, up to a small factor.
template <typename Pose>
double Distance(const Pose& a, const Pose& b) {
  return (Homogeneous(a) - Homogeneous(b)).norm();
}

}  // namespace loopgrid::test_support
