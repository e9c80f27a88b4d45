#include <cstdio>

#include "frontend/log/open_log.h"
#include "frontend/slam/slam.h"

int main(int, char** argv) {
  loopgrid::Slam slam;
  const auto log = loopgrid::OpenLog(argv[1]);
  loopgrid::Observation observation;  // odometry and scan, from wherever you have them
  while (log->Next(&observation)) {
    const loopgrid::TrackedScan tracked = slam.AddScan(observation);
    if (tracked.optimized) std::printf("a loop was closed: older poses have moved\n");
  }
  slam.Finish();
  for (const loopgrid::SE2& pose : slam.ScanPoses()) {
    std::printf("%.3f %.3f %.4f\n", pose.x(), pose.y(), pose.theta());
  }
}
