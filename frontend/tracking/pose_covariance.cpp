#include "frontend/tracking/pose_covariance.h"

#include <Eigen/LU>

namespace loopgrid {

Eigen::Matrix3d ComposeCovariances(const Eigen::Matrix3d& first, const SE2& step,
                                   const Eigen::Matrix3d& second) {
  const Eigen::Matrix3d A = step.Inverse().Adjoint();
  const Eigen::Matrix3d sum = A * first * A.transpose() + second;
  return 0.5 * (sum + sum.transpose());  // symmetric to the last bit
}

Eigen::Matrix3d FuseCovariances(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return (a.inverse() + b.inverse()).inverse();
}

}  // namespace loopgrid
