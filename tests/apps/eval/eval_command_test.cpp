// The command `loopgrid eval`. The metrics are tested in tests/frontend.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "tests/apps/program.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::ProgramResult;
using test_support::RunProgram;
using test_support::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class EvalCommandTest : public ::testing::Test {
 protected:
  /// What eval says about `estimate_` compared with a file of the given content.
  ProgramResult Eval(const std::string& reference, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"eval", estimate_, folder_.Write("reference", reference)});
    return RunProgram(more);
  }

  TemporaryDirectory folder_;
  // Along the x axis, a metre a second.
  std::string estimate_ = folder_.Write("estimate.tum",
                                        "# time x y z qx qy qz qw\n"
                                        "10 0 0 0 0 0 0 1\n"
                                        "11 1 0 0 0 0 0 1\n"
                                        "12 2 0 0 0 0 0 1\n");
};

TEST_F(EvalCommandTest, KnowsRelationsByTheirContent) {
  // The first relation fits exactly. The second has an error of half a metre and 0.1 radians. A
  // time of the third is between two poses, and a time of the fourth is outside the trajectory.
  const std::string relations =
      "10 11 1 0 0 0 0 0\n"
      "10 12 2.5 0 0 0 0 0.1\n"
      "10 11.5 1.5 0 0 0 0 0\n"
      "10 13 3 0 0 0 0 0\n";
  const ProgramResult text = Eval(relations);
  EXPECT_EQ(text.status, 0);
  EXPECT_THAT(text.errors, IsEmpty());
  EXPECT_THAT(text.output, AllOf(StartsWith("compare       "),
                                 HasSubstr("\nexact         2 relations"), HasSubstr("0.2500 +-")));
  const json result = json::parse(Eval(relations, {"--json"}).output);
  EXPECT_EQ(result["metric"], "relations");
  EXPECT_EQ(result["exact"]["count"], 2);
  EXPECT_NEAR(result["exact"]["translation_m"]["mean"], 0.25, 1e-9);
  EXPECT_NEAR(result["exact"]["rotation_deg"]["mean"], 0.05 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_EQ(result["interpolated"]["count"], 1);
  EXPECT_EQ(result["outside"], 1);
}

TEST_F(EvalCommandTest, KnowsATrajectoryByItsContentAndAlignsIt) {
  // The same path at another place, turned by 90 degrees.
  const std::string reference =
      "10 5 5 0 0 0 0.70710678 0.70710678\n"
      "11 5 6 0 0 0 0.70710678 0.70710678\n"
      "12 5 7 0 0 0 0.70710678 0.70710678\n"
      "20 5 8 0 0 0 0.70710678 0.70710678\n";
  EXPECT_THAT(Eval(reference).output, HasSubstr("\ncompared      3 poses"));
  const json result = json::parse(Eval(reference, {"--json"}).output);
  EXPECT_EQ(result["metric"], "trajectory");
  EXPECT_EQ(result["count"], 3);
  EXPECT_EQ(result["unmatched"], 1);
  EXPECT_NEAR(result["translation_m"]["rms"], 0.0, 1e-6);
  EXPECT_NEAR(result["rotation_deg"]["max"], 0.0, 1e-6);
  EXPECT_NEAR(result["alignment"]["theta"], 0.5 * std::numbers::pi, 1e-6);
}

TEST_F(EvalCommandTest, TakesCoarselyRoundedQuaternionsForQuaternions) {
  // Their norm is 0.99 because of rounding. An older version took them for relations.
  const std::string reference =
      "10 5 5 0 0 0 0.7 0.7\n"
      "11 5 6 0 0 0 0.7 0.7\n"
      "12 5 7 0 0 0 0.7 0.7\n";
  const json result = json::parse(Eval(reference, {"--json"}).output);
  EXPECT_EQ(result["metric"], "trajectory");
  EXPECT_NEAR(result["rotation_deg"]["max"], 0.0, 1e-6);
}

TEST_F(EvalCommandTest, SaysWhatIsComparedWithWhat) {
  const std::string file = folder_.File("reference");
  EXPECT_THAT(Eval("10 11 1 0 0 0 0 0\n").output,
              StartsWith("compare       " + estimate_ + " (3 poses) with the relations " + file +
                         " (1 relations; known by content)\n"));
  EXPECT_THAT(Eval("10 0 0 0 0 0 0 1\n").output,
              StartsWith("compare       " + estimate_ + " (3 poses) with the trajectory " + file +
                         " (1 poses; known by content)\n"));
  const json result = json::parse(Eval("10 0 0 0 0 0 0 1\n", {"--json"}).output);
  EXPECT_EQ(result["known_by"], "content");
  EXPECT_EQ(result["estimate"], estimate_);
  EXPECT_EQ(result["reference"], file);
}

TEST_F(EvalCommandTest, CanBeToldWhatTheReferenceIs) {
  // Looks like a trajectory, but can also be two relations with a yaw of 1.
  const std::string both = "10 11 1 0 0 0 0 1\n11 12 1 0 0 0 0 1\n";
  EXPECT_EQ(json::parse(Eval(both, {"--json"}).output)["metric"], "trajectory");
  const json relations = json::parse(Eval(both, {"--json", "--relations"}).output);
  EXPECT_EQ(relations["metric"], "relations");
  EXPECT_EQ(relations["known_by"], "option");
  EXPECT_NEAR(relations["exact"]["rotation_deg"]["mean"], 180.0 / std::numbers::pi, 1e-9);
  const ProgramResult refused = Eval("10 11 1 0 0 0 0 0.2\n", {"--reference"});
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.errors, HasSubstr("reference:1: the quaternion's norm is 0.2, not 1"));
  EXPECT_EQ(Eval(both, {"--reference", "--relations"}).status, 2);
}

TEST_F(EvalCommandTest, AReferenceThroughAPipeGivesTheSameAsAFile) {
  std::string relations;
  for (int i = 0; i < 1000; ++i) relations += "10 11 1 0 0 0 0 0\n";
  const std::string file = folder_.Write("file", relations);
  const json expected = json::parse(RunProgram({"eval", estimate_, file, "--json"}).output);
  EXPECT_EQ(expected["exact"]["count"], 1000);
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  // All of it fits into the pipe's buffer, so write() does not wait for a reader.
  ASSERT_EQ(write(ends[1], relations.data(), relations.size()), std::ssize(relations));
  close(ends[1]);
  const ProgramResult result = RunProgram({"eval", estimate_, "/dev/stdin", "--json"},
                                          [&ends] { dup2(ends[0], STDIN_FILENO); });
  close(ends[0]);
  json found = json::parse(result.output);
  EXPECT_EQ(found["reference"], "/dev/stdin");
  found["reference"] = file;
  EXPECT_EQ(found, expected);
}

TEST_F(EvalCommandTest, WhatCannotBeComparedIsAnInputError) {
  const auto expect_refusal = [](const ProgramResult& result, const std::string& reason) {
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.output, IsEmpty());
    EXPECT_THAT(result.errors, AllOf(StartsWith("loopgrid: "), HasSubstr(reason)));
  };
  expect_refusal(Eval("110 111 1 0 0 0 0 0\n"), "no relation lies within the times of");
  expect_refusal(Eval("110 0 0 0 0 0 0 1\n"), "no pose has the time of one of");
  expect_refusal(Eval(""), "reference: ");
  expect_refusal(Eval("10 11 1 0 0 0 0 0\n10 11 one 0 0 0 0 0\n"), "reference:2: ");
  expect_refusal(RunProgram({"eval", estimate_, folder_.File("none")}), "none: ");
  expect_refusal(RunProgram({"eval", folder_.File(""), estimate_}), folder_.File(""));
}

}  // namespace
}  // namespace loopgrid
