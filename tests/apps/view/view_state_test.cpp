#include "apps/view/view_state.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/apps/view/round_trip.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::RoundTrip;

struct Event {
  std::string name;
  json data;
};

// Throws if the data are not JSON.
std::vector<Event> ParseEvents(const std::string& text) {
  std::vector<Event> events;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    EXPECT_EQ(line.rfind("event: ", 0), 0u) << line;
    const std::string name = line.substr(7);
    std::getline(lines, line);
    EXPECT_EQ(line.rfind("data: ", 0), 0u) << line;
    events.push_back({name, json::parse(line.substr(6))});
    std::getline(lines, line);
    EXPECT_EQ(line, "");
  }
  return events;
}

std::vector<json> Named(const std::string& name, const std::string& text) {
  std::vector<json> found;
  for (const Event& event : ParseEvents(text)) {
    if (event.name == name) found.push_back(event.data);
  }
  return found;
}

json SnapshotOf(const ViewState& state) { return Named("state", state.Snapshot({})).at(0); }

OnlineUpdate UpdateWithClosure(ClosureId id, int from, int to, ClosureOutcome outcome) {
  OnlineUpdate update;
  Closure record;
  record.id = id;
  record.from = from;
  record.to = to;
  record.outcome = outcome;
  record.score = 0.75;
  record.T_from_to = SE2(3.0, 4.0, 0.0);
  update.closures = {record};
  return update;
}

TEST(ViewState, StartsEmptyAndSaysNothingNew) {
  ViewState state("a1", 0.05);
  EXPECT_EQ(state.TakeChanges({}, true), "");
  const json snapshot = SnapshotOf(state);
  EXPECT_EQ(snapshot["run"], "a1");
  EXPECT_EQ(snapshot["resolution"], 0.05);
  EXPECT_EQ(snapshot["tile_side"], 256);
  EXPECT_TRUE(snapshot["pose"].is_null());
  EXPECT_TRUE(snapshot["nodes"].empty());
  EXPECT_FALSE(snapshot["ended"]);
}

// A viewer from the start has the same state as a new one.
TEST(ViewState, LeadsFromStateToStateByItsChanges) {
  RoundTrip trip(60);
  ViewState state("a", 0.05);
  json nodes = json::array();
  json pose;
  json counters;
  for (int scan = 0; scan < trip.scans(); ++scan) {
    if (scan % 20 == 19) trip.MoveNodes(SE2(0.01 * scan, 0.0, 0.001));
    state.Apply(scan % 20 == 19 ? trip.UpdateWithNodes(scan) : trip.Update(scan));
    if (scan % 7 != 0 && scan != 59) continue;
    for (const Event& event : ParseEvents(state.TakeChanges({}, scan % 3 == 2))) {
      if (event.name == "nodes") {
        nodes.erase(nodes.begin() + event.data["first"].get<int>(), nodes.end());
        for (const json& node : event.data["nodes"]) nodes.push_back(node);
      }
      if (event.name == "poses") pose = event.data["poses"].back();
      if (event.name == "counters") counters = event.data;
    }
  }
  const json snapshot = SnapshotOf(state);
  EXPECT_EQ(nodes, snapshot["nodes"]);
  EXPECT_EQ(pose, snapshot["pose"]);
  EXPECT_EQ(counters, snapshot["counters"]);
  EXPECT_EQ(nodes.size(), 20u);
  EXPECT_EQ(counters["scans"], 60);
}

TEST(ViewState, HoldsMovedNodesBackButNotNewOnes) {
  RoundTrip trip(9);
  ViewState state("a", 0.05);
  for (int scan = 0; scan < 6; ++scan) state.Apply(trip.Update(scan));
  state.TakeChanges({}, true);
  trip.MoveNodes(SE2(0.1, 0.0, 0.0));
  state.Apply(trip.UpdateWithNodes(6));
  const json held = Named("nodes", state.TakeChanges({}, false)).at(0);
  EXPECT_EQ(held["first"], 2);
  EXPECT_EQ(held["nodes"].size(), 1u);
  const json moved = Named("nodes", state.TakeChanges({}, true)).at(0);
  EXPECT_EQ(moved["first"], 0);
  EXPECT_EQ(moved["nodes"].size(), 3u);
  EXPECT_EQ(state.TakeChanges({}, true), "");
}

TEST(ViewState, TakesMovedNodesWithoutAScan) {
  RoundTrip trip(9);
  ViewState state("a", 0.05);
  for (int scan = 0; scan < 9; ++scan) state.Apply(trip.Update(scan));
  const json before = SnapshotOf(state);
  trip.MoveNodes(SE2(0.1, 0.0, 0.0));
  OnlineUpdate moved = trip.UpdateWithNodes(8);
  moved.tracked = TrackedScan();
  moved.tracked.scan = -1;
  state.Apply(moved);
  const json after = SnapshotOf(state);
  EXPECT_EQ(after["pose"], before["pose"]);
  EXPECT_EQ(after["counters"], before["counters"]);
  EXPECT_NE(after["nodes"], before["nodes"]);
}

TEST(ViewState, TurnsCovariancesIntoTheMapFrame) {
  OnlineUpdate update;
  update.tracked.T_map_robot = SE2(1.0, 2.0, 0.5 * std::numbers::pi);
  update.tracked.covariance = Eigen::Vector3d(0.04, 0.01, 0.002).asDiagonal();
  ViewState state("a", 0.05);
  state.Apply(update);
  const json covariance = SnapshotOf(state)["pose"]["covariance"];
  EXPECT_NEAR(covariance[0], 0.01, 1e-9);
  EXPECT_NEAR(covariance[1], 0.0, 1e-9);
  EXPECT_NEAR(covariance[2], 0.04, 1e-9);
  EXPECT_NEAR(covariance[3], 0.002, 1e-9);
}

TEST(ViewState, SaysWhatBecameOfClosuresAndWhy) {
  ViewState state("a", 0.05);
  state.Apply(UpdateWithClosure(0, 3, 40, ClosureOutcome::kPending));
  state.Apply(UpdateWithClosure(1, 4, 41, ClosureOutcome::kLowScore));
  json closures = Named("closures", state.TakeChanges({}, true)).at(0)["closures"];
  ASSERT_EQ(closures.size(), 2u);
  EXPECT_EQ(closures[0]["outcome"], "pending");
  EXPECT_EQ(closures[0]["distance"], 5.0);
  EXPECT_EQ(closures[0]["score"], 0.75);
  EXPECT_EQ(closures[1]["reason"], "the scans do not fit well enough");
  const int id = closures[0]["id"];

  state.Apply(UpdateWithClosure(0, 3, 40, ClosureOutcome::kAccepted));
  closures = Named("closures", state.TakeChanges({}, true)).at(0)["closures"];
  ASSERT_EQ(closures.size(), 1u);
  EXPECT_EQ(closures[0]["id"], id) << "still the same closure";
  EXPECT_EQ(closures[0]["outcome"], "accepted");
  const json counters = SnapshotOf(state)["counters"];
  EXPECT_EQ(counters["accepted"], 1);
  EXPECT_EQ(counters["refused"], 1);
  EXPECT_EQ(counters["pending"], 0);
}

TEST(ViewState, TwoClosuresBetweenTheSameNodesAreTwo) {
  ViewState state("a", 0.05);
  state.Apply(UpdateWithClosure(7, 3, 40, ClosureOutcome::kLowScore));
  state.Apply(UpdateWithClosure(9, 3, 40, ClosureOutcome::kAccepted));
  const json snapshot = SnapshotOf(state);
  ASSERT_EQ(snapshot["closures"].size(), 2u);
  EXPECT_EQ(snapshot["closures"][0]["id"], 7);
  EXPECT_EQ(snapshot["closures"][1]["id"], 9);
  EXPECT_EQ(snapshot["counters"]["refused"], 1);
  EXPECT_EQ(snapshot["counters"]["accepted"], 1);
}

TEST(ViewState, NeverForgetsAcceptedClosuresButOldRefusedOnes) {
  ViewState state("a", 0.05);
  for (int i = 0; i < 1000; ++i) {
    state.Apply(UpdateWithClosure(
        i, 0, i, i % 2 == 0 ? ClosureOutcome::kAccepted : ClosureOutcome::kAmbiguous));
  }
  const json snapshot = SnapshotOf(state);
  EXPECT_EQ(snapshot["closures"].size(), 700u);
  EXPECT_EQ(snapshot["counters"]["refused"], 500);
  EXPECT_EQ(snapshot["counters"]["accepted"], 500);
  EXPECT_EQ(Named("closures", state.TakeChanges({}, true)).at(0)["closures"].size(), 700u);
}

TEST(ViewState, TellsAtMostTheNewestPosesOfABatch) {
  ViewState state("a", 0.05);
  OnlineUpdate update;
  for (int scan = 0; scan < 1000; ++scan) {
    update.tracked.scan = scan;
    state.Apply(update);
  }
  const json poses = Named("poses", state.TakeChanges({}, true)).at(0)["poses"];
  EXPECT_EQ(poses.size(), 64u);
  EXPECT_EQ(poses.back()["scan"], 999);
}

TEST(ViewState, StaysJsonWhateverTheNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  OnlineUpdate update = UpdateWithClosure(0, 1, 2, ClosureOutcome::kRejected);
  update.closures[0].score = nan;
  update.closures[0].distance_sigmas = infinity;
  update.tracked.covariance.setConstant(nan);
  update.timestamp = infinity;
  update.latency_seconds = -infinity;
  update.tracked.node = 0;
  ViewState state("a", 0.05);
  state.Apply(update);
  EXPECT_TRUE(SnapshotOf(state)["pose"]["time"].is_null());
  EXPECT_NO_THROW(ParseEvents(state.TakeChanges({{{0, -1, 2}, 7}}, true)));
}

TEST(ViewState, ListsTilesAsTheyAreGiven) {
  ViewState state("a", 0.05);
  const json tiles = Named("tiles", state.TakeChanges({{{1, -2, 3}, 9}}, true)).at(0)["tiles"];
  EXPECT_EQ(tiles, json::parse("[[1,-2,3,9]]"));
}

TEST(ViewState, BreaksThePathWhereTheRobotCannotHaveGone) {
  ViewState state("a", 0.05);
  OnlineUpdate update;
  for (int node = 0; node < 3; ++node) {
    update.tracked.node = node;
    update.tracked.T_map_robot = SE2(node == 2 ? 50.0 : 0.5 * node, 0.0, 0.0);
    state.Apply(update);
  }
  const json nodes = SnapshotOf(state)["nodes"];
  EXPECT_EQ(nodes[0].back(), 0);
  EXPECT_EQ(nodes[1].back(), 1);
  EXPECT_EQ(nodes[2].back(), 0);
}

TEST(ViewState, CountsTheWholePathOfTheRobotNotOnlyItsNodes) {
  ViewState state("a", 0.05);
  // Rounds of a square with a side of 2 m. Only its first corner is a node.
  const SE2 corners[] = {SE2(0, 0, 0), SE2(2, 0, 0), SE2(2, 2, 0), SE2(0, 2, 0)};
  for (int scan = 0; scan < 9; ++scan) {
    OnlineUpdate update;
    update.tracked.scan = scan;
    update.tracked.node = scan == 0 ? 0 : -1;
    update.tracked.T_map_robot = corners[scan % 4];
    update.place.T_node_robot = corners[scan % 4];
    state.Apply(update);
  }
  EXPECT_EQ(SnapshotOf(state)["counters"]["travelled"], 16.0);
}

TEST(ViewState, DoesNotTakeCorrectionsOfTheMapForMotion) {
  ViewState state("a", 0.05);
  for (int scan = 0; scan < 4; ++scan) {
    const SE2 T_map_node(0.0, scan < 2 ? 0.0 : 3.0, 0.0);  // the third scan closes a loop
    OnlineUpdate update;
    update.tracked.scan = scan;
    update.tracked.node = scan == 0 ? 0 : -1;
    update.place = {0, SE2(scan, 0.0, 0.0)};
    update.tracked.T_map_robot = T_map_node * update.place.T_node_robot;
    if (scan == 2) update.nodes = std::make_shared<NodeStates>(NodeStates{{T_map_node}, {}});
    state.Apply(update);
  }
  EXPECT_EQ(SnapshotOf(state)["counters"]["travelled"], 3.0);
}

TEST(ViewState, TellsTheEndOnce) {
  ViewState state("a", 0.05);
  state.End();
  EXPECT_EQ(state.TakeChanges({}, true), "event: end\ndata: {}\n\n");
  EXPECT_EQ(state.TakeChanges({}, true), "");
  EXPECT_TRUE(SnapshotOf(state)["ended"]);
}

}  // namespace
}  // namespace loopgrid
