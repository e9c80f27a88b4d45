#pragma once

#include <optional>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// Finds out where a laser sits on its robot from the two poses that CARMEN's laser messages carry.
/// In a raw log one pose is the other times the mount, on every line. In a log that another mapper
/// corrected, the laser's pose is that mapper's estimate, and their difference says nothing about
/// the mount. The two look the same until the robot has driven and turned: only then is it decided.
class LaserMount {
 public:
  /// `fallback` is the mount where the poses tell nothing.
  explicit LaserMount(const SE2& fallback) : T_robot_laser_(fallback) {}

  /// Takes the poses of the next message, until decided.
  void Add(const SE2& T_odom_laser, const SE2& T_odom_robot);

  /// Settles for what is known so far.
  void Decide();

  /// Settles for a mount known from elsewhere.
  void Set(const SE2& T_robot_laser);

  bool decided() const { return decided_; }

  /// The mount once decided.
  const SE2& T_robot_laser() const { return T_robot_laser_; }

 private:
  SE2 T_robot_laser_;
  bool decided_ = false;
  std::optional<SE2> candidate_;
  SE2 T_odom_robot_first_;
  double farthest_ = 0.0;     // metres from the first message's pose
  double most_turned_ = 0.0;  // radians
  int messages_ = 0;
};

}  // namespace loopgrid
