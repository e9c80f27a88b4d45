// The shape of the trajectory on real recordings, if these are available.

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "frontend/evaluation/trajectory_error.h"
#include "frontend/evaluation/tum_file.h"
#include "frontend/slam/slam.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/support/recordings.h"

namespace loopgrid {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kMostScans = 100;  // sanitizers are slow
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr std::size_t kMostScans = 100;
#else
constexpr std::size_t kMostScans = 100000;
#endif
#else
constexpr std::size_t kMostScans = 100000;
#endif

class RecordedDrive : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedDrive, HasTheShapeOfTheReference) {
  const std::string name = std::string("logs/") + GetParam();
  LOOPGRID_REQUIRE_RECORDING(path, name + ".clf");
  LOOPGRID_REQUIRE_RECORDING(reference_path, name + ".reference.tum");
  Slam slam;
  for (const Observation& observation : test_support::ReadWholeLog(path).observations) {
    if (static_cast<std::size_t>(slam.scan_count()) < kMostScans) slam.AddScan(observation);
  }
  slam.Finish();
  Trajectory estimate;
  const std::vector<SE2> poses = slam.ScanPoses();
  for (int scan = 0; scan < slam.scan_count(); ++scan) {
    estimate.push_back({slam.scan_timestamp(scan), poses[static_cast<std::size_t>(scan)]});
  }
  const TrajectoryEvaluation evaluation = EvaluateTrajectory(estimate, ReadTumFile(reference_path));
  EXPECT_GT(evaluation.translation.count, estimate.size() / 2);
  EXPECT_LE(evaluation.translation.rms,
            0.3);  // the reference is from another mapper and has such errors
  EXPECT_LE(evaluation.rotation.rms, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Short, RecordedDrive, ::testing::Values("aces", "fhw", "seattle"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace loopgrid
