#include "frontend/closing/closure_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "frontend/closing/closure_list.h"
#include "frontend/closing/closure_verifier.h"
#include "tests/frontend/slam/walk.h"
#include "tests/support/index.h"

namespace loopgrid {
namespace {

using test_support::BareCorridor;
using test_support::DistinctiveRoom;
using test_support::ExactLaser;
using test_support::Index;
using test_support::kNodesARound;
using test_support::RoundWalk;
using test_support::ScanFrom;
using test_support::SimulatedLaser;
using test_support::Walk;
using test_support::World;

double TimeOf(std::size_t node) { return 100.0 + 0.5 * static_cast<double>(node); }

// Finder and verifier together, as the pipeline uses them.
class ProposeAndVerify {
 public:
  // The closures that are verified at the newest node of the walk.
  std::vector<ClosureId> Close(Walk* walk) {
    const auto newest = static_cast<std::size_t>(walk->nodes().size() - 1);
    const std::vector<Closure> proposed = finder_.Propose(walk->nodes(), Session(), TimeOf(newest),
                                                          walk->graph().relative_covariances());
    for (const Closure& closure : proposed) {
      const ClosureId id = closures_.Add(closure);
      if (closure.outcome == ClosureOutcome::kPending) verifier_.Add(id);
    }
    return verifier_.Verify(walk->nodes(), false, &closures_);
  }

  // Closes loops at every node of a walk. Ends at the first closures that are verified.
  std::vector<ClosureId> CloseAlong(const std::vector<SE2>& truth,
                                    const std::vector<PointScan>& scans, double sigma, Walk* walk) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
      walk->Add(i == 0 ? truth[0] : truth[i - 1].Inverse() * truth[i], scans[i], sigma);
      std::vector<ClosureId> believed = Close(walk);
      if (!believed.empty()) return believed;
    }
    return {};
  }

  int CountOf(ClosureOutcome outcome) const {
    return static_cast<int>(
        std::count_if(closures().begin(), closures().end(),
                      [&](const Closure& closure) { return closure.outcome == outcome; }));
  }

  const std::vector<Closure>& closures() const { return closures_.all(); }
  void Expire() { verifier_.Expire(&closures_); }

 private:
  ClosureFinder finder_;
  ClosureVerifier verifier_;
  ClosureList closures_;
};

std::vector<PointScan> ScansOf(const World& world, const std::vector<SE2>& poses,
                               const SimulatedLaser& laser = {}) {
  std::vector<PointScan> scans;
  for (const SE2& pose : poses) {
    scans.push_back(ScanFrom(world, pose, laser, static_cast<std::uint32_t>(scans.size())));
  }
  return scans;
}

// A room that does not look like DistinctiveRoom().
World OtherRoom() {
  World world;
  world.AddBox({0.0, 0.0}, {5.2, 5.0}, 0.4);
  return world;
}

TEST(ClosureFinder, ProposesClosuresThatAgreeWithTheTruth) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  Walk walk;
  ProposeAndVerify closer;
  const std::vector<ClosureId> believed =
      closer.CloseAlong(truth, ScansOf(DistinctiveRoom(), truth), 0.02, &walk);
  ASSERT_GE(believed.size(), 3U);
  for (const ClosureId id : believed) {
    const Closure& closure = closer.closures()[Index(id)];
    EXPECT_EQ(closure.outcome, ClosureOutcome::kPending);
    EXPECT_GE(closure.to - closure.from, ClosureGateOptions().recent_nodes);
    EXPECT_EQ(closure.timestamp, TimeOf(Index(closure.to)));
    const SE2 expected = truth[Index(closure.from)].Inverse() * truth[Index(closure.to)];
    EXPECT_LT(closure.T_from_to.Boxminus(expected).norm(), 0.05);
  }
  const Closure& first = closer.closures()[Index(believed.front())];
  const Closure& last = closer.closures()[Index(believed.back())];
  EXPECT_GE(walk.nodes().PathLength(first.to, last.to), ClosureVerifierOptions().min_agreeing_path);
}

TEST(ClosureFinder, OneLookAlikeIsNotBelieved) {
  // From its 18th node on the robot is in another room. The walk ends before it sees that room
  // again.
  const std::vector<SE2> truth = RoundWalk(37);
  std::vector<PointScan> scans = ScansOf(DistinctiveRoom(), truth);
  const std::vector<PointScan> elsewhere = ScansOf(OtherRoom(), truth);
  std::copy(elsewhere.begin() + 18, elsewhere.end(), scans.begin() + 18);
  const std::size_t alike = 30;
  scans[alike] = ScanFrom(DistinctiveRoom(), truth[alike]);
  Walk walk;
  ProposeAndVerify closer;
  EXPECT_TRUE(closer.CloseAlong(truth, scans, 0.02, &walk).empty());
  EXPECT_GE(closer.CountOf(ClosureOutcome::kPending), 1);
  closer.Expire();
  EXPECT_EQ(closer.CountOf(ClosureOutcome::kPending), 0);
  const auto closure =
      std::find_if(closer.closures().begin(), closer.closures().end(),
                   [&](const Closure& c) { return c.to == static_cast<int>(alike); });
  ASSERT_NE(closure, closer.closures().end());
  EXPECT_EQ(closure->outcome, ClosureOutcome::kInconsistent);
}

TEST(ClosureFinder, TriesNoNodesThatTrackingMatchedWith) {
  const std::vector<SE2> truth = RoundWalk(20);
  Walk walk;
  ProposeAndVerify closer;
  EXPECT_TRUE(closer.CloseAlong(truth, ScansOf(DistinctiveRoom(), truth), 0.02, &walk).empty());
  EXPECT_TRUE(closer.closures().empty());
}

// Up and down a corridor without any feature.
std::vector<SE2> UpAndDown() {
  std::vector<SE2> poses;
  for (int i = 0; i < 25; ++i) poses.emplace_back(0.5 * i, 0.0, 0.0);
  for (int i = 24; i >= 0; --i) poses.emplace_back(0.5 * i, 0.1, std::numbers::pi);
  return poses;
}

TEST(ClosureFinder, LeavesOpenWhatABareCorridorLeavesOpen) {
  const std::vector<SE2> truth = UpAndDown();
  Walk walk;
  ProposeAndVerify closer;
  // The poses are so certain that the search windows are narrow. They contain no second place, so
  // only the shape of the score can show that the match is not unique.
  EXPECT_TRUE(
      closer.CloseAlong(truth, ScansOf(BareCorridor(), truth, ExactLaser(360)), 0.002, &walk)
          .empty());
  EXPECT_GE(closer.CountOf(ClosureOutcome::kUnconstrained), 5);
  EXPECT_EQ(closer.CountOf(ClosureOutcome::kPending), 0);
}

TEST(ClosureFinder, FindsManyPlacesAlikeInABareCorridor) {
  const std::vector<SE2> truth = UpAndDown();
  Walk walk;
  ProposeAndVerify closer;
  EXPECT_TRUE(closer.CloseAlong(truth, ScansOf(BareCorridor(), truth, ExactLaser(360)), 0.1, &walk)
                  .empty());
  EXPECT_GE(closer.CountOf(ClosureOutcome::kAmbiguous), 5);
  EXPECT_EQ(closer.CountOf(ClosureOutcome::kPending), 0);
}

TEST(ClosureFinder, BearsNodesWithoutHits) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  Walk walk;
  ProposeAndVerify closer;
  EXPECT_TRUE(closer.CloseAlong(truth, std::vector<PointScan>(truth.size()), 0.02, &walk).empty());
  EXPECT_EQ(closer.CountOf(ClosureOutcome::kLowScore), static_cast<int>(closer.closures().size()));
}

TEST(ClosureFinder, LooksEverywhereForASessionThatIsNotLocalized) {
  // After one round the robot is put down elsewhere in the room, so its pose in the graph is wrong.
  const std::vector<SE2> truth = RoundWalk(kNodesARound);
  Walk walk;
  walk.Follow(DistinctiveRoom(), truth);
  const SE2 carried_to(0.5, 0.5, 2.0);
  walk.Add(SE2(30.0, 0.0, 0.0), ScanFrom(DistinctiveRoom(), carried_to, ExactLaser(360)));
  ClosureFinder finder;
  const auto propose = [&](const Session& session) {
    return finder.Propose(walk.nodes(), session, 0.0, walk.graph().relative_covariances());
  };
  EXPECT_TRUE(propose({.first_node = kNodesARound, .localized = true}).empty());
  const std::vector<Closure> found = propose({.first_node = kNodesARound, .localized = false});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].to, kNodesARound);
  const SE2 pose = walk.nodes().pose(found[0].from) * found[0].T_from_to;
  EXPECT_LT(pose.Boxminus(carried_to).norm(), 0.05);
}

}  // namespace
}  // namespace loopgrid
