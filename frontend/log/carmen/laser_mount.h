#pragma once

#include <optional>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// Finds out where a laser sits on its robot from the two poses that CARMEN's laser messages carry.
/// In a raw log the laser's pose is the robot's pose times the mount, in every message. In a log
/// that another mapper corrected, the laser's pose is that mapper's estimate, and the difference of
/// the two poses says nothing about the mount. Both kinds of log look the same until the robot has
/// driven and turned. So the decision is made after that.
class LaserMount {
 public:
  /// `fallback` is the mount if the poses do not decide it.
  explicit LaserMount(const SE2& fallback) : T_robot_laser_(fallback) {}

  /// Takes the poses of the next message, until decided.
  void Add(const SE2& T_odom_laser, const SE2& T_odom_robot);

  /// Decides now, from the poses so far.
  void Decide();

  /// Sets a mount that is known from elsewhere.
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
