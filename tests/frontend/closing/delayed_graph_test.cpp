#include "frontend/closing/delayed_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::RoundNodes;

TEST(DelayedGraph, IsWhatLoopClosingMadeSoManyStepsAgoWithTheNewerNodesAdded) {
  LoopClosing reference;
  std::vector<ClosingNews> news;
  DelayedGraph graph(true);
  std::vector<SE2> expected;  // poses as they stand
  std::vector<NewNode> nodes = RoundNodes();
  int optimized = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    news.push_back(reference.Add(nodes[k]));
    const auto step = static_cast<std::int64_t>(k);
    ASSERT_EQ(graph.Add(nodes[k], step), static_cast<int>(k));
    std::vector<int> changed;
    const bool moved = graph.TakeDue(step, &changed);

    expected.push_back(k == 0 ? nodes[0].T_parent_node : expected.back() * nodes[k].T_parent_node);
    const auto due = static_cast<std::size_t>(DelayedGraph::kLag);
    const bool has_news = k >= due && news[k - due].optimized;
    EXPECT_EQ(moved, has_news) << k;
    if (has_news) {
      ++optimized;
      expected = news[k - due].optimized->graph.poses;
      for (std::size_t j = expected.size(); j <= k; ++j) {
        expected.push_back(expected.back() * nodes[j].T_parent_node);
      }
    }
    ASSERT_EQ(graph.size(), static_cast<int>(k) + 1);
    for (std::size_t j = 0; j <= k; ++j) {
      ASSERT_EQ(graph.graph().poses[j].coordinates(), expected[j].coordinates()) << k << ' ' << j;
    }
    EXPECT_EQ(changed.size(), k >= due ? news[k - due].records.size() : 0U) << k;
  }
  EXPECT_GT(optimized, 0);
  graph.Finish();
  const ClosingNews last = reference.Finish();
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    EXPECT_EQ(graph.graph().poses[j].coordinates(), last.optimized->graph.poses[j].coordinates());
    EXPECT_EQ(graph.covariance(static_cast<int>(j)), last.optimized->map_covariances[j]);
  }
  EXPECT_EQ(graph.graph().constraints.size(), last.optimized->graph.constraints.size());
  EXPECT_EQ(graph.relative_covariances(), last.optimized->relative_covariances);
}

TEST(DelayedGraph, DoesNotTakeOldNewsForThoseOfANewSession) {
  DelayedGraph graph(false);
  std::vector<NewNode> nodes = RoundNodes();
  std::int64_t step = 0;
  std::vector<int> changed;
  for (int k = 0; k < 10; ++k) graph.Add(nodes[static_cast<std::size_t>(k)], step++);
  NewNode carried = nodes[10];
  carried.new_session = true;
  graph.Add(carried, step);
  EXPECT_EQ(graph.session(), 10);
  // What closing says of the nodes before was true then.
  graph.TakeDue(step + DelayedGraph::kLag - 1, &changed);
  EXPECT_FALSE(graph.localized());
  graph.TakeDue(step + DelayedGraph::kLag, &changed);
  EXPECT_FALSE(graph.localized());
}

}  // namespace
}  // namespace loopgrid
