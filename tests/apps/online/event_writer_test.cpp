#include "apps/online/event_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::ReadFile;
using test_support::TemporaryDirectory;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<json> WrittenEvents(const std::string& path) {
  std::vector<json> events;
  std::istringstream lines(ReadFile(path));
  for (std::string line; std::getline(lines, line);) events.push_back(json::parse(line));
  return events;
}

OnlineUpdate SomeUpdate() {
  OnlineUpdate update;
  update.tracked.scan = 7;
  update.tracked.T_map_robot = SE2(1.5, -2.25, 0.5);
  update.tracked.covariance << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  update.tracked.matched = true;
  update.line = 12;
  update.timestamp = 1234567890.25;
  update.latency_seconds = 0.0015;
  return update;
}

TEST(EventWriter, PoseHasWhatItTakesToSteerBy) {
  const TemporaryDirectory folder;
  EventWriter events(folder.File("events"));
  events.Scan(SomeUpdate());
  events.Flush();
  const json expected = {{"event", "pose"},  {"scan", 7},
                         {"line", 12},       {"time", 1234567890.25},
                         {"x", 1.5},         {"y", -2.25},
                         {"theta", 0.5},     {"covariance", {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}},
                         {"matched", true},  {"localized", true},
                         {"latency_ms", 1.5}};
  EXPECT_THAT(WrittenEvents(folder.File("events")), ::testing::ElementsAre(expected));
}

TEST(EventWriter, NodesClosuresAndOptimizationsFollowThePose) {
  const TemporaryDirectory folder;
  EventWriter events(folder.File("events"));
  OnlineUpdate update = SomeUpdate();
  update.tracked.node = 3;
  update.tracked.optimized = true;
  update.closures.resize(2);
  update.closures[0].to = 3;
  update.closures[0].outcome = ClosureOutcome::kAccepted;
  update.closures[1].from = 1;
  update.closures[1].outcome = ClosureOutcome::kLowScore;
  events.Scan(update);
  events.Flush();
  const std::vector<json> found = WrittenEvents(folder.File("events"));
  ASSERT_EQ(found.size(), 5u);
  EXPECT_EQ(found[1]["event"], "node");
  EXPECT_EQ(found[1]["node"], 3);
  EXPECT_EQ(found[2]["outcome"], "accepted");
  EXPECT_EQ(found[3]["outcome"], "low-score");
  EXPECT_EQ(found[3]["from"], 1);
  EXPECT_EQ(found[3]["reason"], "the scans do not fit well enough");
  EXPECT_EQ(found[4]["event"], "optimization");
}

TEST(EventWriter, NumbersThatJsonHasNoWordForAreNull) {
  const TemporaryDirectory folder;
  EventWriter events(folder.File("events"));
  OnlineUpdate update = SomeUpdate();
  update.tracked.covariance(0, 0) = std::numeric_limits<double>::infinity();
  update.timestamp = std::numeric_limits<double>::quiet_NaN();
  events.Scan(update);
  events.Flush();
  const std::vector<json> found = WrittenEvents(folder.File("events"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0]["covariance"][0].is_null());
  EXPECT_TRUE(found[0]["time"].is_null());
}

TEST(EventWriter, TextStaysJsonWhateverIsInIt) {
  const TemporaryDirectory folder;
  EventWriter events(folder.File("events"));
  events.Warning("caf\xe9 \"quoted\"\n");
  events.Start({}, "\xff", "");
  events.Flush();
  EXPECT_EQ(WrittenEvents(folder.File("events")).size(), 2u);
}

TEST(EventWriter, AddsToAFileThatIsThere) {
  const TemporaryDirectory folder;
  for (int i = 0; i < 2; ++i) {
    EventWriter events(folder.File("events"));
    events.Saved(5);
    events.Flush();
  }
  EXPECT_EQ(WrittenEvents(folder.File("events")).size(), 2u);
}

TEST(EventWriter, WritesNothingWhereNobodyAsked) {
  EventWriter events;
  EXPECT_FALSE(events.enabled());
  events.Scan(SomeUpdate());
  events.End(1, 1, true);
  events.Flush();
}

TEST(EventWriter, OutputThatCannotBeWrittenIsAnError) {
  EventWriter events("/dev/full");
  events.Saved(1);
  EXPECT_THAT([&] { events.Flush(); },
              ThrowsMessage<Error>(HasSubstr("/dev/full: cannot write: No space left")));
  EXPECT_THAT([] { EventWriter("/proc/none/events"); },
              ThrowsMessage<Error>(HasSubstr("/proc/none/events: cannot open: ")));
}

}  // namespace
}  // namespace loopgrid
