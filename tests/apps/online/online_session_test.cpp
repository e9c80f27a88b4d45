#include "apps/online/online_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "tests/apps/small_log.h"
#include "tests/support/portable_random.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::PortableRandom;
using test_support::ReadFile;
using test_support::SmallLog;
using test_support::TemporaryDirectory;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// A journal in a folder and a session on it.
class Session {
 public:
  explicit Session(const TemporaryDirectory& folder, bool resumed = false, bool strict = false)
      : journal_(folder.File("journal.clf")),
        events_(folder.File("events")),
        session_(Options(journal_.path(), strict), &journal_, &events_,
                 [this](const OnlineUpdate& update, bool is_new) {
                   updates_.push_back(update);
                   if (is_new) ++new_scans_;
                 }) {
    session_.Replay(resumed);
  }

  void Send(const std::string& text, bool terminated = true) {
    session_.Add(
        {.text = text, .terminated = terminated, .arrival = std::chrono::steady_clock::now()});
  }

  /// Sends the lines of a text. If the text does not end with a line end, the last line is a cut
  /// one.
  void SendAll(const std::string& text) {
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
      Send(text.substr(begin, end - begin));
    }
    if (begin < text.size()) Send(text.substr(begin), false);
  }

  void End() { session_.End(); }

  std::string Trajectory() {
    std::ostringstream text;
    text.precision(17);
    for (const SE2& pose : session_.mapper()->slam()->ScanPoses()) {
      text << pose.coordinates().transpose() << '\n';
    }
    return text.str();
  }

  const std::vector<OnlineUpdate>& updates() const { return updates_; }
  int new_scans() const { return new_scans_; }
  const LogStatistics& log() { return session_.mapper()->log(); }

 private:
  static RunOptions Options(const std::string& journal, bool strict) {
    RunOptions options;
    options.log = journal;
    options.strict = strict;
    return options;
  }

  Journal journal_;
  EventWriter events_;
  std::vector<OnlineUpdate> updates_;
  int new_scans_ = 0;
  OnlineSession session_;
};

std::vector<json> Events(const TemporaryDirectory& folder, const std::string& kind) {
  std::vector<json> events;
  std::istringstream lines(ReadFile(folder.File("events")));
  for (std::string line; std::getline(lines, line);) {
    const json event = json::parse(line);
    if (event["event"] == kind) events.push_back(event);
  }
  return events;
}

TEST(OnlineSession, AcknowledgesEachScanOnceItsLineIsInTheJournal) {
  const TemporaryDirectory folder;
  Session session(folder);
  session.SendAll(SmallLog(30));
  session.End();
  const std::vector<json> poses = Events(folder, "pose");
  ASSERT_EQ(poses.size(), 30u);
  for (int scan = 0; scan < 30; ++scan) {
    EXPECT_EQ(poses[static_cast<std::size_t>(scan)]["scan"], scan);
    EXPECT_EQ(poses[static_cast<std::size_t>(scan)]["line"], scan + 2);
  }
  EXPECT_TRUE(ReadFile(folder.File("journal.clf")) == SmallLog(30));
  EXPECT_EQ(session.new_scans(), 30);
}

TEST(OnlineSession, UpdatesHaveThePlaceAndTheLatencyOfEachScan) {
  const TemporaryDirectory folder;
  Session session(folder);
  session.SendAll(SmallLog(30));
  ASSERT_FALSE(session.updates().empty());
  for (const OnlineUpdate& update : session.updates()) {
    EXPECT_GE(update.latency_seconds, 0.0);
    EXPECT_LT(update.latency_seconds, 60.0);
    EXPECT_GE(update.place.node, 0);
    EXPECT_EQ(update.line, update.tracked.scan + 2);
  }
  EXPECT_EQ(session.updates().front().tracked.node, 0);
}

TEST(OnlineSession, ResumedAtAnyByteItEndsAsIfNeverInterrupted) {
  std::string log = SmallLog(15) + "ODOM 1 2";
  for (const std::size_t scan : {3u, 9u}) {
    std::size_t line = 0;
    for (std::size_t i = 0; i < scan; ++i) line = log.find('\n', line) + 1;
    log.insert(line, "\nFLASER 3 1 2\n");
  }
  const TemporaryDirectory whole_folder;
  Session whole(whole_folder);
  whole.SendAll(log);
  whole.End();
  PortableRandom random(5);
  for (int round = 0; round < 25; ++round) {
    SCOPED_TRACE(round);
    const TemporaryDirectory folder;
    std::size_t cut = 0;
    for (int crash = 0; crash < 3; ++crash) {
      // The part of the file that was on the disk at a power cut.
      cut += random.Index(log.size() - cut + 1);
      folder.Write("journal.clf", log.substr(0, cut));
      const Session resumed(folder, true);
    }
    const std::size_t line = log.rfind('\n', cut) + 1;
    Session last(folder, true);
    last.SendAll(random.Uniform() < 0.5 ? log : log.substr(line));
    last.End();
    EXPECT_TRUE(ReadFile(folder.File("journal.clf")) == log);
    EXPECT_EQ(last.Trajectory(), whole.Trajectory());
    EXPECT_EQ(last.log().lines, whole.log().lines);
    EXPECT_EQ(last.log().malformed, whole.log().malformed);
  }
}

TEST(OnlineSession, SaysWhereItResumesAndHowMuchItKnows) {
  const TemporaryDirectory folder;
  {
    Session first(folder);
    first.SendAll(SmallLog(10));
  }
  Session second(folder, true);
  second.SendAll(SmallLog(15));
  second.End();
  const std::vector<json> resumed = Events(folder, "resumed");
  ASSERT_EQ(resumed.size(), 1u);
  EXPECT_EQ(resumed[0]["lines"], 11);
  EXPECT_EQ(resumed[0]["scans"], 10);
  const std::vector<json> known = Events(folder, "known");
  ASSERT_EQ(known.size(), 1u);
  EXPECT_EQ(known[0]["lines"], 11);
  EXPECT_EQ(Events(folder, "pose").size(), 15u);
  EXPECT_EQ(second.updates().size(), 15u);
  EXPECT_EQ(second.new_scans(), 5);
}

TEST(OnlineSession, WarnsOfEveryMalformedLine) {
  const TemporaryDirectory folder;
  Session session(folder);
  for (int i = 0; i < 8; ++i) session.Send("FLASER 3 1 2");
  session.End();
  const std::vector<json> warnings = Events(folder, "warning");
  ASSERT_EQ(warnings.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_THAT(warnings[i]["text"], HasSubstr("journal.clf:" + std::to_string(i + 1) + ": "));
  }
}

TEST(OnlineSession, StrictOneStopsAtTheFirstMalformedLine) {
  const TemporaryDirectory folder;
  Session session(folder, false, true);
  session.Send("# fine");
  EXPECT_THAT([&] { session.Send("FLASER 3 1 2"); },
              ThrowsMessage<Error>(HasSubstr("journal.clf:2: ")));
}

}  // namespace
}  // namespace loopgrid
