#include "frontend/tracking/scan_trail.h"

#include <gtest/gtest.h>

#include <memory>

namespace loopgrid {
namespace {

// Node 0 is at scan 0 and node 1 at scan 4. The scans after that belong to node 0 again. Node 2 is
// at scan 8 and joined to node 0; the path to it begins at scan 6.
class Trail : public ::testing::Test {
 protected:
  Trail() {
    graph_.poses = {SE2(), SE2(1.0, 0.0, 0.0), SE2(0.0, 1.0, 0.0)};
    for (int scan = 0; scan <= 8; ++scan) {
      ScanEntry entry;
      entry.timestamp = scan;
      if (scan < 4) entry.place = {0, SE2(0.25 * scan, 0.0, 0.0)};
      if (scan == 4) entry.place = {1, SE2()};
      if (scan > 4) entry.place = {0, SE2(0.0, 0.5 + 0.125 * (scan - 4), 0.0)};
      if (scan == 8) entry.place = {2, SE2()};
      entry.points = std::make_shared<const PointScan>();
      trail_.Add(entry);
      if (scan == 0) trail_.AddNode(-1, SE2(), 0);
      if (scan == 4) trail_.AddNode(0, SE2(1.0, 0.0, 0.0), 0);
      if (scan == 8) trail_.AddNode(0, SE2(0.0, 1.0, 0.0), 6);
    }
  }

  PoseGraph<SE2> graph_;
  ScanTrail trail_;
};

TEST_F(Trail, ScansAreWhereTrackingPutThemAsLongAsNoNodeMoves) {
  for (int scan = 0; scan < trail_.size(); ++scan) {
    const ScanPlace& place = trail_[scan].place;
    const SE2 expected = graph_.poses[static_cast<std::size_t>(place.node)] * place.T_node_robot;
    EXPECT_LT(trail_.Pose(scan, graph_).Boxminus(expected).norm(), 1e-12) << scan;
  }
}

TEST_F(Trail, ScansOnTheWayTakeTheirShareOfWhatTheGraphHasChanged) {
  graph_.poses[1] = SE2(1.2, 0.0, 0.0);
  graph_.poses[2] = SE2(0.0, 1.0, 0.4);
  for (int scan = 0; scan <= 4; ++scan) {
    EXPECT_NEAR(trail_.Pose(scan, graph_).x(), 0.3 * scan, 1e-12) << scan;
  }
  // Scan 5 is not on the path to node 2.
  EXPECT_EQ(trail_.Pose(5, graph_).theta(), 0.0);
  EXPECT_NEAR(trail_.Pose(6, graph_).theta(), 0.0, 1e-12);
  EXPECT_NEAR(trail_.Pose(7, graph_).theta(), 0.2, 1e-12);
  EXPECT_NEAR(trail_.Pose(8, graph_).theta(), 0.4, 1e-12);
}

TEST_F(Trail, NodesKeepThePointsOfTheirScans) {
  EXPECT_EQ(trail_.NodePoints(1), trail_[4].points.get());
  EXPECT_EQ(trail_.node_scans(), (std::vector<int>{0, 4, 8}));
}

}  // namespace
}  // namespace loopgrid
