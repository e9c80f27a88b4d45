#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// Covariance of a pose that was reached from another pose. `first` is the covariance of that other
/// pose in its own frame, `step` leads from it to the new pose, and `second` is the covariance of
/// the step in the frame of its end; their errors are independent. The result is in the frame of
/// the new pose, to first order: Ad(step^-1) first Ad(step^-1)^T + second. Order (x, y, theta),
/// metres and radians.
Eigen::Matrix3d ComposeCovariances(const Eigen::Matrix3d& first, const SE2& step,
                                   const Eigen::Matrix3d& second);

/// Covariance of the combination of two independent estimates of one pose: the inverse of the sum
/// of their information matrices. Both are in the frame of the pose and have to be positive
/// definite.
Eigen::Matrix3d FuseCovariances(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

}  // namespace loopgrid
