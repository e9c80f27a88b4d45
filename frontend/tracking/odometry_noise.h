#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"
#include "frontend/tracking/tracking_options.h"

namespace loopgrid {

/// Covariance of a motion measured by wheel odometry, in the frame of its end, order (x, y, theta).
Eigen::Matrix3d OdometryCovariance(const SE2& motion, const OdometryNoise& noise);

}  // namespace loopgrid
