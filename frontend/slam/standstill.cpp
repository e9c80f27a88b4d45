#include "frontend/slam/standstill.h"

#include <cmath>

namespace loopgrid {

bool Standstill::HasEnough(const SE2& T_map_robot) {
  const SE2 motion = spot_.Inverse() * T_map_robot;
  if (motion.translation().norm() > options_.distance ||
      std::abs(motion.theta()) > options_.angle) {
    spot_ = T_map_robot;
    scans_ = 0;
  }
  return ++scans_ > options_.max_scans;
}

}  // namespace loopgrid
