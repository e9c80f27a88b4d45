#include "frontend/slam/tracking_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "frontend/closing/node_pipeline.h"
#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::RoundNodes;

constexpr int kTestedLag = 5;

// Whether two graphs have the same poses to the last bit.
bool SamePoses(const std::vector<SE2>& a, const std::vector<SE2>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](auto& p, auto& q) {
           return p.coordinates() == q.coordinates();
         });
}

TEST(TrackingGraph, IsWhatThePipelineMadeSoManyStepsAgoWithTheNewerNodesAdded) {
  NodePipeline pipeline;
  std::vector<GraphUpdate> updates;
  TrackingGraph graph(kTestedLag);
  std::vector<SE2> expected;
  const std::vector<NewNode> nodes = RoundNodes();
  int optimized = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    SCOPED_TRACE(k);
    updates.push_back(pipeline.Add(nodes[k]));
    const auto step = static_cast<std::int64_t>(k);
    ASSERT_EQ(graph.Add(nodes[k], step), static_cast<int>(k));
    expected.push_back(k == 0 ? nodes[0].T_parent_node : expected.back() * nodes[k].T_parent_node);
    ASSERT_TRUE(SamePoses(graph.graph().poses, expected));
    if (k < kTestedLag) {
      EXPECT_FALSE(graph.IsUpdateDue(step));
      continue;
    }
    ASSERT_TRUE(graph.IsUpdateDue(step));
    const GraphUpdate& due = updates[k - kTestedLag];
    std::vector<ClosureId> changed;
    EXPECT_EQ(graph.ApplyOldest(due, &changed), due.optimized.has_value());
    EXPECT_EQ(changed.size(), due.closures.size());
    EXPECT_FALSE(graph.IsUpdateDue(step));
    if (due.optimized) {
      ++optimized;
      expected = due.optimized->graph.poses;
      for (std::size_t j = expected.size(); j <= k; ++j) {
        expected.push_back(expected.back() * nodes[j].T_parent_node);
      }
    }
    ASSERT_TRUE(SamePoses(graph.graph().poses, expected));
  }
  EXPECT_GT(optimized, 0);
  EXPECT_EQ(graph.waiting(), kTestedLag);
  std::vector<ClosureId> changed;
  while (graph.waiting() > 0) {
    const auto next = updates.size() - static_cast<std::size_t>(graph.waiting());
    graph.ApplyOldest(updates[next], &changed);
  }
  const GraphUpdate last = pipeline.Finish();
  graph.ApplyLast(last);
  EXPECT_TRUE(SamePoses(graph.graph().poses, last.optimized->graph.poses));
  for (int k = 0; k < graph.size(); ++k) {
    EXPECT_EQ(graph.covariance(k), last.optimized->map_covariances[static_cast<std::size_t>(k)]);
  }
  EXPECT_EQ(graph.graph().constraints.size(), last.optimized->graph.constraints.size());
  EXPECT_EQ(graph.relative_covariances(), last.optimized->relative_covariances);
}

TEST(TrackingGraph, DoesNotTakeUpdatesOfEarlierNodesForThoseOfANewSession) {
  TrackingGraph graph(kTestedLag);
  const std::vector<NewNode> nodes = RoundNodes();
  std::int64_t step = 0;
  for (int k = 0; k < 3; ++k) graph.Add(nodes[static_cast<std::size_t>(k)], step++);
  NewNode carried = nodes[3];
  carried.new_session = true;
  graph.Add(carried, step);
  EXPECT_EQ(graph.session().first_node, 3);
  EXPECT_FALSE(graph.session().localized);
  std::vector<ClosureId> changed;
  GraphUpdate localized;
  localized.localized = true;
  for (int k = 0; k < 3; ++k) graph.ApplyOldest(localized, &changed);
  EXPECT_FALSE(graph.session().localized);  // that update was for the session before
  graph.ApplyOldest(localized, &changed);
  EXPECT_TRUE(graph.session().localized);
}

}  // namespace
}  // namespace loopgrid
