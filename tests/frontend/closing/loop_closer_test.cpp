#include "frontend/closing/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::BareCorridor;
using test_support::DistinctiveRoom;
using test_support::ExactLaser;
using test_support::kNodesARound;
using test_support::RoundWalk;
using test_support::ScanFrom;
using test_support::SimulatedLaser;
using test_support::Walk;
using test_support::World;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

int CountOf(const LoopCloser& closer, ClosureOutcome outcome) {
  return static_cast<int>(
      std::count_if(closer.records().begin(), closer.records().end(),
                    [&](const ClosureRecord& record) { return record.outcome == outcome; }));
}

double TimeOf(std::size_t node) { return 100.0 + 0.5 * static_cast<double>(node); }

// Tries to close loops at every node of a walk; ends at the first closures that are believed.
std::vector<int> CloseAlong(const std::vector<SE2>& truth, const std::vector<PointScan>& scans,
                            double sigma, Walk* walk, LoopCloser* closer) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    walk->Add(i == 0 ? truth[0] : truth[i - 1].Inverse() * truth[i], scans[i], sigma);
    std::vector<int> believed =
        closer->Close(walk->nodes(), TimeOf(i), walk->graph().relative_covariances());
    if (!believed.empty()) return believed;
  }
  return {};
}

std::vector<PointScan> ScansOf(const World& world, const std::vector<SE2>& poses,
                               const SimulatedLaser& laser = {}) {
  std::vector<PointScan> scans;
  for (const SE2& pose : poses) {
    scans.push_back(ScanFrom(world, pose, laser, static_cast<std::uint32_t>(scans.size())));
  }
  return scans;
}

// A room that DistinctiveRoom() cannot be taken for.
World OtherRoom() {
  World world;
  world.AddBox({0.0, 0.0}, {5.2, 5.0}, 0.4);
  return world;
}

TEST(LoopCloser, BelievesThreeHypothesesThatAgree) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  Walk walk;
  LoopCloser closer;
  const std::vector<int> believed =
      CloseAlong(truth, ScansOf(DistinctiveRoom(), truth), 0.02, &walk, &closer);
  ASSERT_GE(believed.size(), 3U);
  for (int index : believed) {
    const ClosureRecord& record = closer.records()[Index(index)];
    EXPECT_EQ(record.outcome, ClosureOutcome::kPending);  // until it is decided
    EXPECT_GE(record.to - record.from, LoopCloserOptions().recent_nodes);
    EXPECT_EQ(record.timestamp, TimeOf(Index(record.to)));
    const SE2 expected = truth[Index(record.from)].Inverse() * truth[Index(record.to)];
    EXPECT_LT(record.T_from_to.Boxminus(expected).norm(), 0.05);
  }
  const ClosureRecord& first = closer.records()[Index(believed.front())];
  const ClosureRecord& last = closer.records()[Index(believed.back())];
  EXPECT_GE(walk.nodes().PathLength(first.to, last.to), LoopCloserOptions().min_agreeing_path);
  closer.Decide(believed, true);
  EXPECT_EQ(CountOf(closer, ClosureOutcome::kAccepted), static_cast<int>(believed.size()));
}

TEST(LoopCloser, DoesNotBelieveOneLookAlike) {
  // From its 18th node on the robot is in another room; it ends before that could be seen again.
  const std::vector<SE2> truth = RoundWalk(37);
  std::vector<PointScan> scans = ScansOf(DistinctiveRoom(), truth);
  const std::vector<PointScan> elsewhere = ScansOf(OtherRoom(), truth);
  std::copy(elsewhere.begin() + 18, elsewhere.end(), scans.begin() + 18);
  const std::size_t alike = 30;
  scans[alike] = ScanFrom(DistinctiveRoom(), truth[alike]);
  Walk walk;
  LoopCloser closer;
  EXPECT_TRUE(CloseAlong(truth, scans, 0.02, &walk, &closer).empty());
  EXPECT_GE(CountOf(closer, ClosureOutcome::kPending), 1);
  closer.Finish();
  EXPECT_EQ(CountOf(closer, ClosureOutcome::kPending), 0);
  EXPECT_EQ(CountOf(closer, ClosureOutcome::kAccepted), 0);
  const auto record =
      std::find_if(closer.records().begin(), closer.records().end(),
                   [&](const ClosureRecord& r) { return r.to == static_cast<int>(alike); });
  ASSERT_NE(record, closer.records().end());
  EXPECT_EQ(record->outcome, ClosureOutcome::kInconsistent);
}

TEST(LoopCloser, TriesNoNodesThatTrackingMatchedWith) {
  const std::vector<SE2> truth = RoundWalk(20);
  Walk walk;
  LoopCloser closer;
  EXPECT_TRUE(CloseAlong(truth, ScansOf(DistinctiveRoom(), truth), 0.02, &walk, &closer).empty());
  EXPECT_TRUE(closer.records().empty());
}

// Up and down a corridor without any feature.
std::vector<SE2> UpAndDown() {
  std::vector<SE2> poses;
  for (int i = 0; i < 25; ++i) poses.emplace_back(0.5 * i, 0.0, 0.0);
  for (int i = 24; i >= 0; --i) poses.emplace_back(0.5 * i, 0.1, std::numbers::pi);
  return poses;
}

TEST(LoopCloser, LeavesOpenWhatABareCorridorLeavesOpen) {
  const std::vector<SE2> truth = UpAndDown();
  Walk walk;
  LoopCloser closer;
  // Poses so sure that the windows are narrow: no second place can be seen, only the score's shape.
  const auto believed =
      CloseAlong(truth, ScansOf(BareCorridor(), truth, ExactLaser(360)), 0.002, &walk, &closer);
  EXPECT_TRUE(believed.empty());
  EXPECT_GE(CountOf(closer, ClosureOutcome::kUnconstrained), 5);
  EXPECT_EQ(CountOf(closer, ClosureOutcome::kPending), 0);
}

TEST(LoopCloser, FindsManyPlacesAlikeInABareCorridor) {
  const std::vector<SE2> truth = UpAndDown();
  Walk walk;
  LoopCloser closer;
  const auto believed =
      CloseAlong(truth, ScansOf(BareCorridor(), truth, ExactLaser(360)), 0.1, &walk, &closer);
  EXPECT_TRUE(believed.empty());
  EXPECT_GE(CountOf(closer, ClosureOutcome::kAmbiguous), 5);
  EXPECT_EQ(CountOf(closer, ClosureOutcome::kPending), 0);
}

TEST(LoopCloser, WhatIsRejectedDoesNotSupportOthersLater) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  const std::vector<PointScan> scans = ScansOf(DistinctiveRoom(), truth);
  Walk walk;
  LoopCloser closer;
  const std::vector<int> believed = CloseAlong(truth, scans, 0.02, &walk, &closer);
  ASSERT_FALSE(believed.empty());
  closer.Decide(believed, false);
  EXPECT_EQ(CountOf(closer, ClosureOutcome::kRejected), static_cast<int>(believed.size()));
  const auto next = static_cast<std::size_t>(walk.nodes().size());
  walk.Add(truth[next - 1].Inverse() * truth[next], scans[next]);
  const auto again = closer.Close(walk.nodes(), TimeOf(next), walk.graph().relative_covariances());
  for (int index : again) {
    EXPECT_EQ(std::count(believed.begin(), believed.end(), index), 0) << index;
  }
}

TEST(LoopCloser, SetsTheErrorAndTheFateOfAcceptedClosuresOnly) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  Walk walk;
  LoopCloser closer;
  const std::vector<int> believed =
      CloseAlong(truth, ScansOf(DistinctiveRoom(), truth), 0.02, &walk, &closer);
  ASSERT_FALSE(believed.empty());
  closer.Decide(believed, true);
  closer.Finish();
  for (std::size_t i = 0; i < closer.records().size(); ++i) {
    const ClosureRecord before = closer.records()[i];
    closer.SetChi2(before.from, before.to, 7.5);
    closer.Reject(before.from, before.to);
    const bool was_accepted = before.outcome == ClosureOutcome::kAccepted;
    EXPECT_EQ(closer.records()[i].chi2, was_accepted ? 7.5 : before.chi2) << i;
    EXPECT_EQ(closer.records()[i].outcome,
              was_accepted ? ClosureOutcome::kRejected : before.outcome)
        << i;
  }
  closer.Reject(1000, 2000);  // no such closure
}

TEST(LoopCloser, BearsNodesWithoutHits) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  Walk walk;
  LoopCloser closer;
  EXPECT_TRUE(
      CloseAlong(truth, std::vector<PointScan>(truth.size()), 0.02, &walk, &closer).empty());
  EXPECT_EQ(CountOf(closer, ClosureOutcome::kLowScore), static_cast<int>(closer.records().size()));
}

}  // namespace
}  // namespace loopgrid
