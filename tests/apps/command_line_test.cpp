#include "apps/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Command Parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "loopgrid");
  return ParseCommandLine(static_cast<int>(arguments.size()), arguments.data());
}

std::string UsageError(const std::vector<const char*>& arguments) {
  try {
    Parse(arguments);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST(CommandLine, RunTakesALogAndAFolderAndHasDefaultsForAllElse) {
  const auto run = std::get<RunOptions>(Parse({"run", "a.clf", "--out", "b"}));
  EXPECT_EQ(run.log, "a.clf");
  EXPECT_EQ(run.out, "b");
  EXPECT_EQ(run.resolution, 0.05);
  EXPECT_EQ(run.slam.node_distance, SlamOptions().node_distance);
  EXPECT_EQ(run.slam.node_angle, SlamOptions().node_angle);
  EXPECT_FALSE(run.strict);
  EXPECT_FALSE(run.quiet);
  EXPECT_NO_THROW(run.Validate());
}

TEST(CommandLine, EveryOptionOfRunReachesItsField) {
  const auto run = std::get<RunOptions>(
      Parse({"run", "a.clf", "--out=b", "--resolution", "0.1", "--node-distance", "0.7",
             "--node-angle", "0.3", "--strict", "--quiet"}));
  EXPECT_EQ(run.resolution, 0.1);
  EXPECT_EQ(run.slam.node_distance, 0.7);
  EXPECT_EQ(run.slam.node_angle, 0.3);
  EXPECT_TRUE(run.strict);
  EXPECT_TRUE(run.quiet);
}

TEST(CommandLine, EvalTakesTwoFiles) {
  const auto eval = std::get<EvalOptions>(Parse({"eval", "a.tum", "b.relations", "--json"}));
  EXPECT_EQ(eval.estimate, "a.tum");
  EXPECT_EQ(eval.reference, "b.relations");
  EXPECT_TRUE(eval.json);
}

TEST(CommandLine, VersionIsOneLine) {
  const std::string text = std::get<Answer>(Parse({"--version"})).text;
  EXPECT_THAT(text, ::testing::MatchesRegex("loopgrid [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(CommandLine, HelpOfTheProgramNamesItsCommands) {
  const std::string text = std::get<Answer>(Parse({"--help"})).text;
  EXPECT_THAT(text, HasSubstr("run "));
  EXPECT_THAT(text, HasSubstr("eval "));
  EXPECT_THAT(text, HasSubstr("Exit status"));
}

TEST(CommandLine, HelpOfRunExplainsEveryOptionWithUnitAndDefault) {
  const std::string text = std::get<Answer>(Parse({"run", "--help"})).text;
  EXPECT_THAT(text, HasSubstr("LOG"));
  EXPECT_THAT(text, HasSubstr("--out DIR"));
  EXPECT_THAT(text, HasSubstr("--resolution METRES=0.05"));
  EXPECT_THAT(text, HasSubstr("--node-distance METRES=0.5"));
  EXPECT_THAT(text, HasSubstr("--node-angle RADIANS=0.5"));
  EXPECT_THAT(text, HasSubstr("--strict"));
  EXPECT_THAT(text, HasSubstr("--quiet"));
}

TEST(CommandLine, WhatMakesNoSenseIsAUsageErrorOfOneLine) {
  UsageError({});
  UsageError({"walk"});
  UsageError({"run"});
  UsageError({"eval", "a.tum"});
  UsageError({"eval", "a.tum", "b.tum", "c.tum"});
  EXPECT_THAT(UsageError({"run", "a.clf"}), HasSubstr("--out"));
  EXPECT_THAT(UsageError({"run", "a.clf", "--out", "b", "--speed", "3"}), HasSubstr("--speed"));
  EXPECT_THAT(UsageError({"run", "a.clf", "--out", "b", "--resolution", "fine"}),
              HasSubstr("--resolution"));
}

TEST(RunOptions, OutOfRangeIsNamedWithValueAndBound) {
  for (const char* value : {"0", "-1", "0.009", "1.1", "nan", "inf"}) {
    const auto run =
        std::get<RunOptions>(Parse({"run", "a.clf", "--out", "b", "--resolution", value}));
    try {
      run.Validate();
      ADD_FAILURE() << value;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUsage);
      EXPECT_THAT(error.what(), HasSubstr("resolution is " + std::string(value)));
      EXPECT_THAT(error.what(), HasSubstr("0.01 to 1"));
    }
  }
}

TEST(RunOptions, OptionsOfTheMapperAreCheckedToo) {
  const auto run =
      std::get<RunOptions>(Parse({"run", "a.clf", "--out", "b", "--node-distance", "-3"}));
  EXPECT_THROW(run.Validate(), Error);
}

}  // namespace
}  // namespace loopgrid
