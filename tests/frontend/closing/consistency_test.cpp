#include "frontend/closing/consistency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace loopgrid {
namespace {

using Members = std::vector<int>;

// Agreement inside the given groups; `between` across them.
Eigen::MatrixXd Groups(int count, const std::vector<Members>& groups, double inside = 0.8,
                       double between = 0.0) {
  Eigen::MatrixXd agreement = Eigen::MatrixXd::Constant(count, count, between);
  for (const Members& group : groups) {
    for (int i : group) {
      for (int k : group) agreement(i, k) = inside;
    }
  }
  agreement.diagonal().setOnes();
  return agreement;
}

double MeanAgreement(const Eigen::MatrixXd& agreement, const Members& members) {
  return agreement(members, members).sum() / static_cast<double>(members.size());
}

TEST(FindConsistentSet, FindsTheLargerOfTwoGroups) {
  const ConsistentSet set = FindConsistentSet(Groups(7, {{0, 2, 4, 6}, {1, 3, 5}}));
  EXPECT_EQ(set.members, (Members{0, 2, 4, 6}));
  EXPECT_NEAR(set.separation, 3.4 / 2.6, 1e-9);  // the eigenvalues are 1 + (n - 1) * 0.8
}

TEST(FindConsistentSet, LeavesOutOneThatAgreesWithNone) {
  for (int stray = 0; stray < 5; ++stray) {
    Members others(5);
    std::iota(others.begin(), others.end(), 0);
    others.erase(others.begin() + stray);
    const ConsistentSet set = FindConsistentSet(Groups(5, {others}, 0.7, 0.02));
    EXPECT_EQ(set.members, others);
    EXPECT_GT(set.separation, 2.5);
  }
}

TEST(FindConsistentSet, TakesAllWhereAllAgree) {
  const ConsistentSet set = FindConsistentSet(Groups(4, {{0, 1, 2, 3}}));
  EXPECT_EQ(set.members, (Members{0, 1, 2, 3}));
  EXPECT_NEAR(set.separation, 3.4 / 0.2, 1e-9);
}

TEST(FindConsistentSet, IsASingleOneWhereNoneAgree) {
  const ConsistentSet set = FindConsistentSet(Eigen::MatrixXd::Identity(5, 5));
  EXPECT_EQ(set.members.size(), 1U);
  EXPECT_NEAR(set.separation, 1.0, 1e-9);
}

TEST(FindConsistentSet, OfOneOrNoneIsThat) {
  EXPECT_EQ(FindConsistentSet(Eigen::MatrixXd::Identity(1, 1)).members, Members{0});
  EXPECT_TRUE(FindConsistentSet(Eigen::MatrixXd(0, 0)).members.empty());
}

TEST(FindConsistentSet, TwoEqualGroupsAreNotSeparate) {
  EXPECT_LT(FindConsistentSet(Groups(6, {{0, 1, 2}, {3, 4, 5}})).separation, 1.0 + 1e-9);
}

TEST(FindConsistentSet, IsNearlyAsGoodAsTheBestOfAllSubsets) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform;
    constexpr int kCount = 9;
    Eigen::MatrixXd agreement = Eigen::MatrixXd::Identity(kCount, kCount);
    for (int i = 0; i < kCount; ++i) {
      for (int k = 0; k < i; ++k) {
        const double value = uniform(random);
        agreement(i, k) = agreement(k, i) = value * value * value;
      }
    }
    double best = 0.0;
    for (unsigned subset = 1; subset < (1U << kCount); ++subset) {
      Members members;
      for (int i = 0; i < kCount; ++i) {
        if ((subset >> i) & 1U) members.push_back(i);
      }
      best = std::max(best, MeanAgreement(agreement, members));
    }
    const ConsistentSet set = FindConsistentSet(agreement);
    EXPECT_TRUE(std::is_sorted(set.members.begin(), set.members.end()));
    EXPECT_GE(MeanAgreement(agreement, set.members), 0.9 * best);
  }
}

}  // namespace
}  // namespace loopgrid
