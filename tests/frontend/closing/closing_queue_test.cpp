#include "frontend/closing/closing_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::RoundNodes;

void ExpectSameNews(const ClosingNews& a, const ClosingNews& b) {
  ASSERT_EQ(a.records.size(), b.records.size());
  for (std::size_t i = 0; i < a.records.size(); ++i) {
    EXPECT_EQ(a.records[i].first, b.records[i].first);
    EXPECT_EQ(a.records[i].second.outcome, b.records[i].second.outcome);
    EXPECT_EQ(a.records[i].second.T_from_to.coordinates(),
              b.records[i].second.T_from_to.coordinates());
  }
  EXPECT_EQ(a.localized, b.localized);
  ASSERT_EQ(a.optimized.has_value(), b.optimized.has_value());
  if (!a.optimized) return;
  ASSERT_EQ(a.optimized->graph.poses.size(), b.optimized->graph.poses.size());
  for (std::size_t k = 0; k < a.optimized->graph.poses.size(); ++k) {
    EXPECT_EQ(a.optimized->graph.poses[k].coordinates(), b.optimized->graph.poses[k].coordinates());
  }
  EXPECT_EQ(a.optimized->relative_covariances, b.optimized->relative_covariances);
  EXPECT_EQ(a.optimized->map_covariances, b.optimized->map_covariances);
}

TEST(ClosingQueue, GivesTheSameNewsWithAndWithoutAThreadHoweverLateTheyAreTaken) {
  const std::vector<NewNode> nodes = RoundNodes();
  LoopClosing reference;
  ClosingQueue threaded(true);
  ClosingQueue deferred(false);
  std::vector<ClosingNews> expected;
  for (const NewNode& node : nodes) {
    expected.push_back(reference.Add(node));
    threaded.Submit(node);
    deferred.Submit(node);
    if (threaded.size() < 7) continue;
    const ClosingNews& oldest = expected[expected.size() - 7];
    ExpectSameNews(threaded.Take(), oldest);
    ExpectSameNews(deferred.Take(), oldest);
  }
  EXPECT_EQ(threaded.size(), 6);
  while (threaded.size() > 0) {
    const ClosingNews& oldest =
        expected[expected.size() - static_cast<std::size_t>(threaded.size())];
    ExpectSameNews(threaded.Take(), oldest);
    ExpectSameNews(deferred.Take(), oldest);
  }
  const ClosingNews last = reference.Finish();
  ASSERT_TRUE(last.optimized);
  ExpectSameNews(threaded.Finish(), last);
  ExpectSameNews(deferred.Finish(), last);
  // There was something to compare.
  EXPECT_TRUE(std::any_of(expected.begin(), expected.end(),
                          [](const ClosingNews& news) { return news.optimized.has_value(); }));
}

TEST(ClosingQueue, EndsWithWorkLeftOver) {
  const std::vector<NewNode> nodes = RoundNodes();
  for (bool threaded : {true, false}) {
    ClosingQueue queue(threaded);
    for (const NewNode& node : nodes) queue.Submit(node);
    EXPECT_EQ(queue.size(), static_cast<int>(nodes.size()));
  }
}

}  // namespace
}  // namespace loopgrid
