#include "frontend/closing/closure_list.h"

#include <gtest/gtest.h>

#include <set>

namespace loopgrid {
namespace {

using Ids = std::set<ClosureId>;

TEST(ClosureList, NumbersClosuresInOrder) {
  ClosureList closures;
  for (int to = 40; to < 45; ++to) {
    Closure closure;
    closure.to = to;
    const ClosureId id = closures.Add(closure);
    EXPECT_EQ(id, to - 40);
    EXPECT_EQ(closures[id].id, id);
    EXPECT_EQ(closures[id].to, to);
  }
  EXPECT_EQ(closures.all().size(), 5U);
}

TEST(ClosureList, TellsOnceWhichAreNewOrHaveChanged) {
  ClosureList closures;
  for (int i = 0; i < 4; ++i) closures.Add({});
  EXPECT_EQ(closures.TakeChanged(), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(closures.TakeChanged(), Ids{});
  closures.SetChi2(2, 7.5);
  closures.SetOutcome(1, ClosureOutcome::kAccepted);
  EXPECT_EQ(closures[2].chi2, 7.5);
  EXPECT_EQ(closures[1].outcome, ClosureOutcome::kAccepted);
  EXPECT_EQ(closures.TakeChanged(), (Ids{1, 2}));
  closures.SetChi2(2, 7.5);  // as before
  EXPECT_EQ(closures.TakeChanged(), Ids{});
}

}  // namespace
}  // namespace loopgrid
