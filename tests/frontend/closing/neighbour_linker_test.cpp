#include "frontend/closing/neighbour_linker.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tests/frontend/slam/walk.h"
#include "tests/support/index.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::Index;
using test_support::kNodesARound;
using test_support::RoundWalk;
using test_support::Walk;

TEST(LinkNeighbours, JoinsThePassesByOnePlaceWhereTheyReallyAre) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  Walk walk;
  walk.Follow(DistinctiveRoom(), truth,
              SE2(0.002, 0.001, 0.0003));  // an error of 5 cm for each round
  const std::vector<Constraint<SE2>> links = LinkNeighbours(walk.nodes());
  EXPECT_GE(links.size(), 30U);
  std::vector<int> linked;
  for (const Constraint<SE2>& link : links) {
    SCOPED_TRACE(link.from * 1000 + link.to);
    EXPECT_TRUE(link.robust);
    EXPECT_GT(std::abs(link.to - link.from), NeighbourLinkerOptions().same_pass);
    const SE2 expected = truth[Index(link.from)].Inverse() * truth[Index(link.to)];
    const Eigen::Vector3d error = link.T_from_to.Boxminus(expected);
    EXPECT_LT(error.head<2>().norm(), 0.04);
    EXPECT_LT(std::abs(error.z()), 0.015);
    EXPECT_EQ(link.information.llt().info(), Eigen::Success);
    linked.push_back(link.to);
  }
  const bool second_round_linked = std::count_if(linked.begin(), linked.end(), [](int node) {
                                     return node >= kNodesARound;
                                   }) >= kNodesARound / 2;
  EXPECT_TRUE(second_round_linked);
}

TEST(LinkNeighbours, JoinsNoNodesOfOnePass) {
  NeighbourLinkerOptions options;
  options.same_pass = 100;
  Walk walk;
  walk.Follow(DistinctiveRoom(), RoundWalk(2 * kNodesARound));
  EXPECT_TRUE(LinkNeighbours(walk.nodes(), options).empty());
}

TEST(LinkNeighbours, SparesNodesThatHaveAClosureNearby) {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  Walk walk;
  walk.Follow(DistinctiveRoom(), truth);
  std::vector<ClosureConstraint> closures;
  for (int i = 0; i < kNodesARound; ++i) {
    const int again = i + kNodesARound;
    closures.push_back({i,
                        {i, again, truth[Index(i)].Inverse() * truth[Index(again)],
                         1e4 * Eigen::Matrix3d::Identity(), true}});
  }
  const std::size_t without = LinkNeighbours(walk.nodes()).size();
  ASSERT_TRUE(walk.graph().TryClosures(closures));
  const std::vector<Constraint<SE2>> links = LinkNeighbours(walk.nodes());
  EXPECT_LT(links.size(), without);
  for (const Constraint<SE2>& link : links) {
    const int closed_with =
        link.to < kNodesARound ? link.to + kNodesARound : link.to - kNodesARound;
    EXPECT_GT(std::abs(link.from - closed_with), NeighbourLinkerOptions().already_linked);
  }
}

TEST(LinkNeighbours, BelievesNoMatchFarFromTheGraphsOpinion) {
  Walk walk;
  walk.Follow(DistinctiveRoom(), RoundWalk(2 * kNodesARound), SE2(0.002, 0.001, 0.0003));
  NeighbourLinkerOptions options;
  options.max_shift = 1e-6;
  EXPECT_TRUE(LinkNeighbours(walk.nodes(), options).empty());
  options = {};
  options.max_turn = 1e-7;
  EXPECT_TRUE(LinkNeighbours(walk.nodes(), options).empty());
}

TEST(LinkNeighbours, OfNoNodesOrEmptyScansIsNothing) {
  Walk none;
  EXPECT_TRUE(LinkNeighbours(none.nodes()).empty());
  Walk blind;
  blind.Follow({}, RoundWalk(2 * kNodesARound));
  EXPECT_TRUE(LinkNeighbours(blind.nodes()).empty());
}

}  // namespace
}  // namespace loopgrid
