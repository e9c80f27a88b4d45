#pragma once

#include <string>

#include "frontend/slam/slam_options.h"

namespace loopgrid {

/// Options of `loopgrid run`.
struct RunOptions {
  std::string log;           ///< the log to read
  std::string out;           ///< the folder for the files
  double resolution = 0.05;  ///< side of a map cell, metres
  bool strict = false;       ///< stop at the first malformed line
  bool quiet = false;        ///< no progress bar
  SlamOptions slam;

  /// Throws Error (kUsage) naming the option, its value and its bounds.
  void Validate() const;
};

}  // namespace loopgrid
