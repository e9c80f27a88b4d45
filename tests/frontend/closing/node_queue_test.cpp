#include "frontend/closing/node_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::RoundNodes;

void ExpectSameUpdates(const GraphUpdate& a, const GraphUpdate& b) {
  ASSERT_EQ(a.closures.size(), b.closures.size());
  for (std::size_t i = 0; i < a.closures.size(); ++i) {
    EXPECT_EQ(a.closures[i].id, b.closures[i].id);
    EXPECT_EQ(a.closures[i].outcome, b.closures[i].outcome);
    EXPECT_EQ(a.closures[i].T_from_to.coordinates(), b.closures[i].T_from_to.coordinates());
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

TEST(NodeQueue, GivesTheSameUpdatesWithAndWithoutAThreadHoweverLateTheyAreTaken) {
  const std::vector<NewNode> nodes = RoundNodes();
  NodePipeline reference;
  NodeQueue threaded(true);
  NodeQueue deferred(false);
  std::vector<GraphUpdate> expected;
  for (const NewNode& node : nodes) {
    expected.push_back(reference.Add(node));
    threaded.Submit(node);
    deferred.Submit(node);
    if (threaded.size() < 7) continue;
    const GraphUpdate& oldest = expected[expected.size() - 7];
    ExpectSameUpdates(threaded.Take(), oldest);
    ExpectSameUpdates(deferred.Take(), oldest);
  }
  EXPECT_EQ(threaded.size(), 6);
  while (threaded.size() > 0) {
    const GraphUpdate& oldest =
        expected[expected.size() - static_cast<std::size_t>(threaded.size())];
    ExpectSameUpdates(threaded.Take(), oldest);
    ExpectSameUpdates(deferred.Take(), oldest);
  }
  const GraphUpdate last = reference.Finish();
  ASSERT_TRUE(last.optimized);
  ExpectSameUpdates(threaded.Finish(), last);
  ExpectSameUpdates(deferred.Finish(), last);
  // Make sure that there was something to compare.
  EXPECT_TRUE(std::any_of(expected.begin(), expected.end(),
                          [](const GraphUpdate& update) { return update.optimized.has_value(); }));
}

TEST(NodeQueue, EndsWithWorkLeftOver) {
  const std::vector<NewNode> nodes = RoundNodes();
  for (bool threaded : {true, false}) {
    NodeQueue queue(threaded);
    for (const NewNode& node : nodes) queue.Submit(node);
    EXPECT_EQ(queue.size(), static_cast<int>(nodes.size()));
  }
}

}  // namespace
}  // namespace loopgrid
