// Any bytes as a CARMEN log: nothing may crash, and every scan is as LaserScan says.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "backend/base/error.h"
#include "frontend/log/open_log.h"
#include "tests/support/memory_file.h"

namespace {

void Require(bool condition) {
  if (!condition) std::abort();
}

void RequireSound(const loopgrid::Observation& observation) {
  const loopgrid::LaserScan& scan = observation.scan;
  Require(std::isfinite(observation.timestamp));
  Require(observation.T_odom_robot.coordinates().allFinite());
  Require(scan.T_robot_laser.coordinates().allFinite());
  Require(std::isfinite(scan.first_angle) && std::isfinite(scan.angle_step));
  Require(scan.angle_step != 0.0 && std::isfinite(scan.max_range) && scan.max_range >= 0.0);
  Require(!scan.ranges.empty());
  for (const float range : scan.ranges) Require(std::isfinite(range) && range >= 0.0F);
}

loopgrid::LogStatistics ReadAll(const std::string& path, bool strict) {
  loopgrid::LogReaderOptions options;
  options.strict = strict;
  const auto reader = loopgrid::OpenLog(path, options);
  loopgrid::Observation observation;
  while (reader->Next(&observation)) RequireSound(observation);
  return reader->statistics();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.find('\0') != bytes.npos) return 0;  // such bytes go to the rawlog reader
  const loopgrid::test_support::MemoryFile file(bytes);
  loopgrid::LogStatistics lenient;
  try {
    lenient = ReadAll(file.path(), false);
  } catch (const loopgrid::Error&) {
    return 0;
  }
  Require(lenient.first_problems.empty() == (lenient.malformed == 0));
  bool refused = false;
  try {
    ReadAll(file.path(), true);
  } catch (const loopgrid::Error&) {
    refused = true;
  }
  Require(refused == (lenient.malformed > 0));
  return 0;
}
