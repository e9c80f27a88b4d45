#include "frontend/closing/node_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "frontend/tracking/pose_covariance.h"
#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::RoundNodes;

TEST(NodePipeline, TellsOfEachClosureWhatItHasBecome) {
  NodePipeline pipeline;
  std::vector<Closure> told;
  const auto listen = [&told](const GraphUpdate& update) {
    ClosureId last = kNoClosure;
    for (const Closure& closure : update.closures) {
      EXPECT_GT(closure.id, last);
      last = closure.id;
      const auto place = static_cast<std::size_t>(closure.id);
      ASSERT_LE(place, told.size());  // in order, and none is missing
      if (place == told.size()) told.emplace_back();
      told[place] = closure;
    }
  };
  for (const NewNode& node : RoundNodes()) listen(pipeline.Add(node));
  const GraphUpdate last = pipeline.Finish();
  listen(last);
  ASSERT_FALSE(told.empty());
  // The accepted closures are those in the graph, with their chi2 there.
  const PoseGraph<SE2>& graph = last.optimized->graph;
  int accepted = 0;
  for (const Closure& closure : told) {
    EXPECT_NE(closure.outcome, ClosureOutcome::kPending);
    const auto found = std::find_if(graph.constraints.begin(), graph.constraints.end(),
                                    [&](const Constraint<SE2>& c) {
                                      return c.robust && c.from == closure.from &&
                                             c.to == closure.to && c.T_from_to == closure.T_from_to;
                                    });
    ASSERT_EQ(found != graph.constraints.end(), closure.outcome == ClosureOutcome::kAccepted);
    if (closure.outcome != ClosureOutcome::kAccepted) continue;
    ++accepted;
    const Eigen::Vector3d error = (graph.poses[static_cast<std::size_t>(closure.from)].Inverse() *
                                   graph.poses[static_cast<std::size_t>(closure.to)])
                                      .Boxminus(closure.T_from_to);
    EXPECT_NEAR(closure.chi2, error.dot(found->information * error), 1e-9 * (1.0 + closure.chi2));
  }
  EXPECT_GE(accepted, 3);
}

TEST(NodePipeline, ANodeMayBeJoinedToAnyOther) {
  std::vector<NewNode> nodes = RoundNodes();
  nodes.resize(12);
  NodePipeline pipeline;
  for (const NewNode& node : nodes) pipeline.Add(node);
  NewNode branch = nodes.back();
  branch.parent = 4;
  branch.T_parent_node = SE2(0.3, 0.1, 0.2);
  branch.gap = 3.0;
  pipeline.Add(branch);
  const GraphUpdate update = pipeline.Finish();
  ASSERT_TRUE(update.optimized);
  const OptimizedGraph& optimized = *update.optimized;
  ASSERT_EQ(optimized.graph.poses.size(), 13U);
  EXPECT_EQ(optimized.graph.constraints[11].from, 4);
  EXPECT_EQ(optimized.graph.constraints[11].to, 12);
  const SE2 step = optimized.graph.poses[4].Inverse() * optimized.graph.poses[12];
  EXPECT_LT(step.Boxminus(branch.T_parent_node).norm(), 1e-6);
  // Node 4 is one step away from it, and node 11 seven more steps.
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
