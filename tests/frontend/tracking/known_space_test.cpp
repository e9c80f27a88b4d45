#include "frontend/tracking/known_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

PoseGraph<SE2> NodesAt(const std::vector<double>& xs) {
  PoseGraph<SE2> graph;
  for (double x : xs) graph.poses.emplace_back(x, 0.0, 0.0);
  return graph;
}

TEST(NearestNodes, AreThoseThatSortingFinds) {
  test_support::PortableRandom random(7);
  PoseGraph<SE2> graph;
  for (int i = 0; i < 200; ++i) {
    // On a coarse lattice, so that many distances are equal.
    const double x = std::floor(random.Uniform(-5.0, 5.0));
    const double y = std::floor(random.Uniform(-5.0, 5.0));
    graph.poses.emplace_back(x, y, 0.0);
  }
  const Eigen::Vector2d position(0.0, 0.0);
  for (int end : {0, 1, 10, 200}) {
    for (int count : {0, 1, 30, 500}) {
      std::vector<int> expected(static_cast<std::size_t>(end));
      std::iota(expected.begin(), expected.end(), 0);
      std::stable_sort(expected.begin(), expected.end(), [&](int a, int b) {
        const auto squared = [&](int k) {
          return (graph.poses[static_cast<std::size_t>(k)].translation() - position).squaredNorm();
        };
        return squared(a) < squared(b);
      });
      if (count < end) expected.resize(static_cast<std::size_t>(count));
      EXPECT_EQ(NearestNodes(graph, end, position, count), expected) << end << ' ' << count;
    }
  }
}

TEST(KnownSpace, TakesThreePassesOfOneSession) {
  // Nodes at the place, then more than `same_pass` nodes away from it, and so on.
  std::vector<double> xs;
  const auto pass_by = [&xs] {
    for (double x : {-0.4, 0.1, 0.6}) xs.push_back(x);
    for (int i = 0; i < 12; ++i) xs.push_back(20.0 + i);
  };
  const KnownSpaceOptions options;
  const Eigen::Vector2d here(0.0, 0.0);
  const auto is_known = [&](int session) {
    const int count = static_cast<int>(xs.size());
    return IsKnown(NodesAt(xs), count, session, here, options);
  };
  EXPECT_FALSE(is_known(0));
  pass_by();
  EXPECT_FALSE(is_known(0));
  pass_by();
  EXPECT_FALSE(is_known(0));
  // ... unless the robot was there in an earlier session.
  EXPECT_TRUE(is_known(1));
  pass_by();
  EXPECT_TRUE(is_known(0));
  EXPECT_FALSE(IsKnown(NodesAt(xs), 30, 0, here, options));  // before the third
  EXPECT_FALSE(IsKnown(NodesAt(xs), static_cast<int>(xs.size()), 0, {0.0, 1.01}, options));
}

TEST(KnownSpace, LingeringIsOnePass) {
  const std::vector<double> xs(100, 0.0);
  EXPECT_FALSE(IsKnown(NodesAt(xs), 100, 0, {0.0, 0.0}, {}));
}

}  // namespace
}  // namespace loopgrid
