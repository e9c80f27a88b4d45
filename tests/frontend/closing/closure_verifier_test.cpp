#include "frontend/closing/closure_verifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::kNodesARound;
using test_support::RoundWalk;
using test_support::Walk;

// Two rounds without scans, because only poses matter here.
class ClosureVerification : public ::testing::Test {
 protected:
  ClosureVerification() {
    const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      walk_.Add(i == 0 ? truth[0] : truth[i - 1].Inverse() * truth[i], PointScan());
    }
  }

  const Nodes& nodes() const { return walk_.nodes(); }

  // A closure between the two passes by one place, with the error `error`, as the finder proposes
  // it.
  ClosureId Propose(int to, const SE2& error = SE2()) {
    Closure closure;
    closure.from = to - kNodesARound;
    closure.to = to;
    closure.T_from_to = nodes().Between(closure.from, to) * error;
    closure.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
    const ClosureId id = closures_.Add(closure);
    verifier_.Add(id);
    return id;
  }

  std::vector<ClosureId> Verify(bool anywhere = false) {
    return verifier_.Verify(nodes(), anywhere, &closures_);
  }

  Walk walk_;
  ClosureList closures_;
  ClosureVerifier verifier_;
};

TEST_F(ClosureVerification, BelievesThreeThatAgreeAndNotTheOneThatDoesNot) {
  Propose(40);
  Propose(42, SE2(1.0, 0.5, 0.2));
  EXPECT_TRUE(Verify().empty());
  Propose(44);
  EXPECT_TRUE(Verify().empty());
  Propose(46);
  EXPECT_EQ(Verify(), (std::vector<ClosureId>{0, 2, 3}));
}

TEST_F(ClosureVerification, ARobotThatMayBeAnywhereNeedsFour) {
  for (int to : {40, 42, 44}) Propose(to);
  EXPECT_TRUE(Verify(true).empty());
  EXPECT_EQ(Verify(false).size(), 3U);
  Propose(46);
  EXPECT_EQ(Verify(true).size(), 4U);
}

TEST_F(ClosureVerification, ThreeOnOneSpotProveNothing) {
  for (int to : {45, 46, 46}) Propose(to);  // half a metre of travel
  EXPECT_TRUE(Verify().empty());
}

TEST_F(ClosureVerification, ThoseInTheGraphSupportOthersButAreNotBelievedAgain) {
  for (int to : {38, 40, 42}) Propose(to);
  for (const ClosureId id : Verify()) closures_.SetOutcome(id, ClosureOutcome::kAccepted);
  const ClosureId next = Propose(44);
  EXPECT_EQ(Verify(), std::vector<ClosureId>{next});
}

TEST_F(ClosureVerification, ThoseForgottenSupportNoOthers) {
  for (int to : {38, 40, 42}) Propose(to);
  const std::vector<ClosureId> believed = Verify();
  ASSERT_EQ(believed.size(), 3U);
  verifier_.Forget(believed);
  Propose(44);
  EXPECT_TRUE(Verify().empty());
}

TEST_F(ClosureVerification, ThoseTooOldBecomeInconsistent) {
  const ClosureId old = Propose(26);  // the newest node is 47
  const ClosureId recent = Propose(27);
  Verify();
  EXPECT_EQ(closures_[old].outcome, ClosureOutcome::kInconsistent);
  EXPECT_EQ(closures_[recent].outcome, ClosureOutcome::kPending);
  verifier_.Expire(&closures_);
  EXPECT_EQ(closures_[recent].outcome, ClosureOutcome::kInconsistent);
}

}  // namespace
}  // namespace loopgrid
