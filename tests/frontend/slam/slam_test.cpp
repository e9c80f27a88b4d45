// The whole front-end on simulated drives with known poses.

#include "frontend/slam/slam.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "frontend/evaluation/trajectory_error.h"
#include "tests/support/index.h"
#include "tests/support/office_world.h"
#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::Index;
using test_support::SimulatedRun;

// Twice round the distinctive room.
SimulatedRun RoomRun() {
  std::vector<Eigen::Vector2d> route;
  for (int round = 0; round < 2; ++round) {
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(-1.3, -1.3), {1.6, -1.2}, {1.5, 1.5}, {-1.2, 1.4}}) {
      route.push_back(corner);
    }
  }
  return Simulate(DistinctiveRoom(), route);
}

void AddAll(const SimulatedRun& run, Slam* slam) {
  for (const Observation& observation : run.observations) slam->AddScan(observation);
}

TrajectoryEvaluation Evaluate(const SimulatedRun& run, const std::vector<SE2>& poses) {
  Trajectory estimate;
  Trajectory truth;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    estimate.push_back({run.observations[i].timestamp, poses[i]});
    truth.push_back({run.observations[i].timestamp, run.true_poses[i]});
  }
  return EvaluateTrajectory(estimate, truth);
}

bool IsFinite(const Slam& slam) {
  const std::vector<SE2> poses = slam.ScanPoses();
  const std::vector<Eigen::Matrix3d> covariances = slam.NodeCovariances();
  const SlamStatistics statistics = slam.statistics();
  return std::all_of(poses.begin(), poses.end(),
                     [](const SE2& pose) { return pose.coordinates().allFinite(); }) &&
         std::all_of(covariances.begin(), covariances.end(),
                     [](const Eigen::Matrix3d& m) { return m.allFinite(); }) &&
         std::isfinite(statistics.error_before) && std::isfinite(statistics.error_after);
}

void ExpectSameBits(const Slam& a, const Slam& b) {
  ASSERT_EQ(a.graph().poses.size(), b.graph().poses.size());
  ASSERT_EQ(a.graph().constraints.size(), b.graph().constraints.size());
  const std::vector<SE2> a_poses = a.ScanPoses();
  const std::vector<SE2> b_poses = b.ScanPoses();
  ASSERT_EQ(a_poses.size(), b_poses.size());
  for (std::size_t i = 0; i < a_poses.size(); ++i) {
    ASSERT_EQ(a_poses[i].coordinates(), b_poses[i].coordinates()) << i;
  }
  for (std::size_t i = 0; i < a.graph().constraints.size(); ++i) {
    ASSERT_EQ(a.graph().constraints[i].information, b.graph().constraints[i].information) << i;
  }
  ASSERT_EQ(a.NodeCovariances(), b.NodeCovariances());
  ASSERT_EQ(a.closures().size(), b.closures().size());
}

TEST(Slam, FollowsADriveThroughAnOfficeAndClosesItsLoops) {
  const SimulatedRun run = test_support::OfficeRun();
  Slam slam;
  AddAll(run, &slam);
  slam.Finish();

  const std::vector<SE2> poses = slam.ScanPoses();
  ASSERT_EQ(poses.size(), run.observations.size());
  const TrajectoryEvaluation evaluation = Evaluate(run, poses);
  EXPECT_LT(evaluation.translation.maximum, 0.1);
  EXPECT_LT(evaluation.rotation.maximum, 1.0);
  EXPECT_EQ(slam.statistics().failed_matches, 0);

  // Some closures are accepted, none of these is wrong, and each of them is in the graph.
  int accepted = 0;
  for (const Closure& record : slam.closures()) {
    if (record.outcome != ClosureOutcome::kAccepted) continue;
    ++accepted;
    const SE2& from = run.true_poses[Index(slam.node_scans()[Index(record.from)])];
    const SE2& to = run.true_poses[Index(slam.node_scans()[Index(record.to)])];
    EXPECT_LT(record.T_from_to.Boxminus(from.Inverse() * to).norm(), 0.15)
        << record.from << " - " << record.to;
    const auto& constraints = slam.graph().constraints;
    EXPECT_TRUE(std::any_of(constraints.begin(), constraints.end(), [&](const Constraint<SE2>& c) {
      return c.from == record.from && c.to == record.to && c.robust;
    }));
  }
  EXPECT_GE(accepted, 10);
  for (const Closure& record : slam.closures()) {
    EXPECT_NE(record.outcome, ClosureOutcome::kPending);
  }

  EXPECT_LT(slam.statistics().error_after, 0.1 * slam.statistics().error_before);
  EXPECT_TRUE(IsFinite(slam));
}

TEST(Slam, AddsANodeAfterTheAskedForTravelOrTurn) {
  const SimulatedRun run = RoomRun();
  SlamOptions options;
  options.node_distance = 0.7;
  options.node_angle = 0.6;
  Slam slam(options);
  AddAll(run, &slam);
  ASSERT_EQ(slam.scan_count(), static_cast<int>(run.observations.size()));
  const std::vector<int>& scans = slam.node_scans();
  ASSERT_EQ(scans.size(), slam.graph().poses.size());
  EXPECT_EQ(scans[0], 0);
  for (std::size_t k = 0; k + 1 < scans.size(); ++k) {
    // By the true poses, which tracking follows to a few centimetres, nodes are far enough apart,
    // and not much farther.
    const SE2& node = run.true_poses[Index(scans[k])];
    const SE2 step = node.Inverse() * run.true_poses[Index(scans[k + 1])];
    EXPECT_TRUE(step.translation().norm() > 0.6 || std::abs(step.theta()) > 0.57) << k;
    for (int scan = scans[k]; scan < scans[k + 1]; ++scan) {
      const SE2 way = node.Inverse() * run.true_poses[Index(scan)];
      EXPECT_LT(way.translation().norm(), 0.8) << scan;
      EXPECT_LT(std::abs(way.theta()), 0.63) << scan;
    }
  }
}

TEST(Slam, TellsOfEachScanWhatBecameOfIt) {
  const SimulatedRun run = RoomRun();
  Slam slam;
  int nodes = 0;
  for (std::size_t i = 0; i < run.observations.size(); ++i) {
    const TrackedScan tracked = slam.AddScan(run.observations[i]);
    EXPECT_TRUE(tracked.matched) << i;
    if (tracked.node >= 0) {
      EXPECT_EQ(tracked.node, nodes++);
      EXPECT_EQ(slam.node_scans()[Index(tracked.node)], static_cast<int>(i));
    }
    EXPECT_EQ(tracked.covariance, tracked.covariance.transpose().eval());
    EXPECT_TRUE(i == 0 ? tracked.covariance.isZero(0.0) : tracked.covariance(0, 0) > 0.0);
    EXPECT_LT(slam.ScanPoses().back().Boxminus(tracked.T_map_robot).norm(), 1e-9);
    const int scan = static_cast<int>(i);
    EXPECT_EQ(slam.scan_timestamp(scan), run.observations[i].timestamp);
    EXPECT_EQ(slam.scan_odometry(scan).coordinates(),
              run.observations[i].T_odom_robot.coordinates());
    EXPECT_EQ(slam.scan_laser(scan).x(), run.observations[i].scan.T_robot_laser.x());
    EXPECT_EQ(slam.scan_hits(scan).size() + slam.scan_no_returns(scan).size(),
              run.observations[i].scan.ranges.size());
  }
  EXPECT_EQ(slam.statistics().scans, static_cast<std::int64_t>(run.observations.size()));
  EXPECT_TRUE(slam.NodeCovariances().back().isZero(0.0));
}

TEST(Slam, DoesTheSameInEveryRunOnOneThreadOrTwo) {
  const SimulatedRun run = RoomRun();
  SlamOptions single;
  single.threads = 1;
  Slam first;
  Slam second(single);
  AddAll(run, &first);
  AddAll(run, &second);
  ExpectSameBits(first, second);
  first.Finish();
  second.Finish();
  ExpectSameBits(first, second);
  const TrajectoryEvaluation evaluation = Evaluate(run, first.ScanPoses());
  EXPECT_LT(evaluation.translation.maximum, 0.05);
}

TEST(Slam, EndsWithoutAnyScan) {
  Slam slam;
  slam.Finish();
  EXPECT_EQ(slam.scan_count(), 0);
  EXPECT_TRUE(slam.ScanPoses().empty());
  EXPECT_TRUE(slam.NodeCovariances().empty());
  EXPECT_TRUE(slam.closures().empty());
  EXPECT_TRUE(slam.graph().poses.empty());
  EXPECT_EQ(slam.statistics().scans, 0);
  EXPECT_EQ(slam.statistics().error_after, 0.0);
}

TEST(Slam, TakesASingleScan) {
  const SimulatedRun run = RoomRun();
  Slam slam;
  const TrackedScan tracked = slam.AddScan(run.observations[40]);
  EXPECT_EQ(tracked.node, 0);
  slam.Finish();
  ASSERT_EQ(slam.ScanPoses().size(), 1U);
  EXPECT_TRUE(slam.ScanPoses()[0].coordinates().isZero(0.0));
  EXPECT_TRUE(IsFinite(slam));
}

TEST(Slam, GoesByTheOdometryWhereNoBeamReturns) {
  SimulatedRun run = RoomRun();
  for (Observation& observation : run.observations) {
    std::fill(observation.scan.ranges.begin(), observation.scan.ranges.end(), 81.83F);
  }
  Slam slam;
  AddAll(run, &slam);
  slam.Finish();
  EXPECT_TRUE(IsFinite(slam));
  const std::vector<SE2> poses = slam.ScanPoses();
  const SE2 T_start_odom = run.observations[0].T_odom_robot.Inverse();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(poses[i].Boxminus(T_start_odom * run.observations[i].T_odom_robot).norm(), 1e-6);
  }
  const SlamStatistics statistics = slam.statistics();
  EXPECT_EQ(statistics.unusable_scans, statistics.scans - 1);
  EXPECT_EQ(statistics.failed_matches, statistics.scans - 1);
  EXPECT_LT(statistics.error_after, 1e-6);
}

TEST(Slam, BearsAwkwardLogs) {
  // Scans without returns, erroneous readings, other numbers of beams, and a robot that jumps and
  // stands still.
  SimulatedRun run = RoomRun();
  run.observations.resize(60);
  for (std::size_t i = 0; i < run.observations.size(); ++i) {
    Observation& observation = run.observations[i];
    std::vector<float>& ranges = observation.scan.ranges;
    if (i % 7 == 1) std::fill(ranges.begin(), ranges.end(), 0.0F);
    if (i % 7 == 2) ranges.resize(1);
    if (i % 7 == 3) std::fill(ranges.begin(), ranges.end(), kFarthestReading);
    if (i % 7 == 4) std::fill(ranges.begin(), ranges.end(), 1.0F);
    if (i % 11 == 5) observation.T_odom_robot = SE2(1e3, -1e3, 2.0);
    if (i % 5 == 0) observation.timestamp = -1e9;
  }
  Slam slam;
  for (const Observation& observation : run.observations) {
    EXPECT_TRUE(slam.AddScan(observation).T_map_robot.coordinates().allFinite());
    slam.AddScan(observation);  // again, without any motion
  }
  slam.Finish();
  EXPECT_TRUE(IsFinite(slam));
}

TEST(Slam, IsTheSameObjectAfterAMove) {
  const SimulatedRun run = RoomRun();
  const std::size_t half = run.observations.size() / 2;
  Slam straight;
  Slam before;
  for (std::size_t i = 0; i < half; ++i) {
    straight.AddScan(run.observations[i]);
    before.AddScan(run.observations[i]);
  }
  Slam after(std::move(before));
  before = Slam();  // a moved-from object can be given a new value
  before.AddScan(run.observations[0]);
  EXPECT_EQ(before.scan_count(), 1);
  Slam assigned;
  assigned.AddScan(run.observations[3]);
  assigned = std::move(after);
  for (std::size_t i = half; i < run.observations.size(); ++i) {
    straight.AddScan(run.observations[i]);
    assigned.AddScan(run.observations[i]);
  }
  ExpectSameBits(straight, assigned);
}

}  // namespace
}  // namespace loopgrid
