#include "frontend/log/carmen/laser_mount.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

constexpr double kSame = 1e-4;          // metres and radians: equal except for rounding
constexpr double kConstant = 5e-3;      // metres and radians: largest variation of a fixed mount
constexpr double kLargestMount = 2.0;   // metres
constexpr double kEnoughTravel = 0.2;   // metres
constexpr double kEnoughTurning = 0.2;  // radians
constexpr int kPatience = 500;          // messages

bool Near(const SE2& a, const SE2& b, double tolerance) {
  return a.Boxminus(b).cwiseAbs().maxCoeff() <= tolerance;
}

}  // namespace

void LaserMount::Add(const SE2& T_odom_laser, const SE2& T_odom_robot) {
  if (decided_) return;
  const SE2 T_robot_laser = T_odom_robot.Inverse() * T_odom_laser;
  if (!candidate_) {
    candidate_ = T_robot_laser;
    T_odom_robot_first_ = T_odom_robot;
  }
  const bool possible = !Near(*candidate_, SE2(), kSame) &&
                        candidate_->translation().norm() <= kLargestMount &&
                        Near(T_robot_laser, *candidate_, kConstant);
  if (!possible) {
    decided_ = true;  // for the fallback
    return;
  }
  const SE2 moved = T_odom_robot_first_.Inverse() * T_odom_robot;
  farthest_ = std::max(farthest_, moved.translation().norm());
  most_turned_ = std::max(most_turned_, std::abs(moved.theta()));
  const bool proven = farthest_ >= kEnoughTravel && most_turned_ >= kEnoughTurning;
  if (proven || ++messages_ >= kPatience) Decide();
}

void LaserMount::Decide() {
  if (!decided_ && candidate_) T_robot_laser_ = *candidate_;
  decided_ = true;
}

void LaserMount::Set(const SE2& T_robot_laser) {
  T_robot_laser_ = T_robot_laser;
  decided_ = true;
}

}  // namespace loopgrid
