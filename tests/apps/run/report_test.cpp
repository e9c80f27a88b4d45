#include "apps/run/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace loopgrid {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

RunReport SomeReport() {
  RunReport report;
  report.options.log = "some/office.clf";
  report.options.out = "some/maps";
  report.options.resolution = 0.1;
  report.log.scans = 120;
  report.slam.scans = 120;
  report.slam.failed_matches = 2;
  report.slam.error_before = 1234.5;
  report.slam.error_after = 6.25;
  report.nodes = 30;
  report.constraints = 45;
  report.closures = {{"accepted", 5}, {"low-score", 2}, {"inconsistent", 1}};
  report.map_width = 200;
  report.map_height = 100;
  report.map_resolution = 0.1;
  report.data_seconds = 60.0;
  report.total_seconds = 0.5;
  report.peak_memory_mb = 42.0;
  return report;
}

TEST(ReportJson, HoldsTheCounts) {
  const json report = json::parse(FormatReportJson(SomeReport()));
  EXPECT_EQ(report["version"], LOOPGRID_VERSION);
  EXPECT_EQ(report["scans"], 120);
  EXPECT_EQ(report["nodes"], 30);
  EXPECT_EQ(report["constraints"], 45);
  EXPECT_EQ(report["closures"]["tried"], 8);
  EXPECT_EQ(report["closures"]["accepted"], 5);
  EXPECT_EQ(report["closures"]["outcomes"]["inconsistent"], 1);
  EXPECT_EQ(report["error"]["before"], 1234.5);
  EXPECT_EQ(report["error"]["after"], 6.25);
  EXPECT_EQ(report["options"]["resolution"], 0.1);
  EXPECT_EQ(report["map"]["width"], 200);
  EXPECT_EQ(report["timings"]["real_time_factor"], 120.0);
}

TEST(ReportJson, OnlyTimingsDifferBetweenTwoRuns) {
  RunReport other = SomeReport();
  other.options.out = "other/maps";
  other.slam.times.tracking = 3.0;
  other.drawing_seconds = 1.0;
  other.writing_seconds = 2.0;
  other.total_seconds = 9.0;
  other.peak_memory_mb = 99.0;
  json a = json::parse(FormatReportJson(SomeReport()));
  json b = json::parse(FormatReportJson(other));
  EXPECT_NE(a, b);
  a.erase("timings");
  b.erase("timings");
  EXPECT_EQ(a, b);
}

TEST(ReportJson, StaysJsonWhateverTheFileIsCalled) {
  RunReport report = SomeReport();
  report.options.log = "caf\xe9 \"quoted\"\n.clf";
  EXPECT_TRUE(json::accept(FormatReportJson(report)));
}

TEST(Summary, NamesWhatWasFoundAndWhereItIs) {
  const std::string text = FormatSummary(SomeReport());
  EXPECT_THAT(text, HasSubstr("120"));
  EXPECT_THAT(text, HasSubstr("30 nodes, 45 constraints"));
  EXPECT_THAT(text, HasSubstr("5 made of 8 tried"));
  EXPECT_THAT(text, HasSubstr("1234.5 before, 6.25 after"));
  EXPECT_THAT(text, HasSubstr("200 x 100 cells of 0.1 m (20.0 m x 10.0 m)"));
  EXPECT_THAT(text, HasSubstr("0.50 s for 60 s of data (120 x real time)"));
  EXPECT_THAT(text, HasSubstr("some/maps"));
  EXPECT_THAT(text, Not(HasSubstr("malformed")));
}

TEST(Summary, ShowsTheFirstProblemsOfABadLog) {
  RunReport report = SomeReport();
  report.log.malformed = 7;
  report.log.first_problems = {"office.clf:3: a reading is missing"};
  const std::string text = FormatSummary(report);
  EXPECT_THAT(text, HasSubstr("7 lines skipped"));
  EXPECT_THAT(text, HasSubstr("office.clf:3: a reading is missing\n"));
}

TEST(RecordingClock, StepsBackAndPausesCountButClocksThatAreSetDoNot) {
  RecordingClock clock;
  EXPECT_EQ(clock.seconds(), 0.0);
  for (double t : {100.0, 101.0, 100.5, 102.0, 402.0, 1.0e9, 1.0e9 + 8.0}) clock.Add(t);
  EXPECT_DOUBLE_EQ(clock.seconds(), 2.0 + 300.0 + 8.0);
}

}  // namespace
}  // namespace loopgrid
