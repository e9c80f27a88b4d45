#include "frontend/closing/loop_closing.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::RoundNodes;

TEST(LoopClosing, TellsOfEachRecordWhatItHasBecome) {
  LoopClosing closing;
  std::vector<ClosureRecord> told;
  const auto listen = [&told](const ClosingNews& news) {
    for (const auto& [index, record] : news.records) {
      const auto place = static_cast<std::size_t>(index);
      ASSERT_LE(place, told.size());  // in order, none left out
      if (place == told.size()) told.emplace_back();
      told[place] = record;
    }
  };
  for (const NewNode& node : RoundNodes()) listen(closing.Add(node));
  listen(closing.Finish());
  ASSERT_FALSE(told.empty());
  int accepted = 0;
  for (const ClosureRecord& record : told) {
    EXPECT_NE(record.outcome, ClosureOutcome::kPending);
    accepted += record.outcome == ClosureOutcome::kAccepted ? 1 : 0;
  }
  EXPECT_GE(accepted, 3);
}

TEST(LoopClosing, ANodeMayBeJoinedToAnyOther) {
  std::vector<NewNode> nodes = RoundNodes();
  nodes.resize(12);
  LoopClosing closing;
  for (const NewNode& node : nodes) closing.Add(node);
  NewNode branch = nodes.back();
  branch.parent = 4;
  branch.T_parent_node = SE2(0.3, 0.1, 0.2);
  branch.gap = 3.0;
  closing.Add(branch);
  const ClosingNews news = closing.Finish();
  ASSERT_TRUE(news.optimized);
  const OptimizedGraph& optimized = *news.optimized;
  ASSERT_EQ(optimized.graph.poses.size(), 13U);
  EXPECT_EQ(optimized.graph.constraints[11].from, 4);
  EXPECT_EQ(optimized.graph.constraints[11].to, 12);
  const SE2 step = optimized.graph.poses[4].Inverse() * optimized.graph.poses[12];
  EXPECT_LT(step.Boxminus(branch.T_parent_node).norm(), 1e-6);
  // Node 4 is one step away from it, node 11 seven steps and that.
  EXPECT_TRUE(optimized.relative_covariances[4].isApprox(
      branch.T_parent_node.Adjoint() * branch.covariance *
          branch.T_parent_node.Adjoint().transpose(),
      1e-6));
  EXPECT_GT(optimized.relative_covariances[11](0, 0), optimized.relative_covariances[4](0, 0));
  EXPECT_TRUE(optimized.map_covariances[12].isApprox(
      ComposeCovariances(optimized.map_covariances[4], branch.T_parent_node, branch.covariance),
      1e-6));
}

}  // namespace
}  // namespace loopgrid
