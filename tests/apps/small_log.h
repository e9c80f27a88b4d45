#pragma once

#include <string>

namespace loopgrid::test_support {

/// A CARMEN log of a robot that drives a circle in a bare rectangular room: `scans` FLASER lines of
/// 180 exact readings, ten a metre, with exact odometry. For tests that need a simple log.
std::string SmallLog(int scans);

/// Another scan of that room, but with odometry 300 km away.
std::string StrayScan();

/// Five scans 90 m apart: a map of them with cells of 0.01 m is longer than an image may be.
std::string LongWay();

}  // namespace loopgrid::test_support
