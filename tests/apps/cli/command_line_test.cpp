#include "apps/cli/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/choices.h"
#include "backend/base/error.h"
#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

using test_support::ParseWords;
using test_support::UsageErrorOf;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

enum class Colour { kRed, kGreen };

constexpr std::array kColours = {Choice{"red", Colour::kRed}, Choice{"green", Colour::kGreen}};

/// A made-up program with an argument of every type.
class CommandLineTest : public ::testing::Test {
 protected:
  Program program_{
      .name = "paint",
      .version = "1.2.3",
      .summary = "Paints.",
      .footer = "Below the commands.",
      .commands = {
          {.name = "wall",
           .summary = "Paint a wall",
           .arguments = {{.name = "WALL", .help = "Which", .target = &wall_, .required = true},
                         {.name = "--note", .unit = "TEXT", .help = "A note", .target = &note_},
                         {.name = "--coats",
                          .unit = "N",
                          .help = "How many",
                          .target = &coats_,
                          .shows_default = true,
                          .given = [this] { coats_given_ = true; }},
                         {.name = "--area",
                          .unit = "M2",
                          .help = "How large",
                          .target = &area_,
                          .shows_default = true},
                         {.name = "--id", .unit = "ID", .help = "Number", .target = &id_},
                         {.name = "--limit", .unit = "X", .help = "Most", .target = &limit_},
                         {.name = "--seed", .unit = "S", .help = "Seed", .target = &seed_},
                         {.name = "--colour",
                          .help = "Which",
                          .target = OneOf(kColours, Colour::kGreen, &colour_)},
                         {.name = "--dry", .help = "Without paint", .target = &dry_}},
           .footer = "Below the options."},
          {.name = "floors",
           .summary = "Paint floors",
           .arguments = {{.name = "FLOOR", .help = "Any", .target = &floors_, .required = true},
                         {.name = "--out",
                          .unit = "FILE",
                          .help = "Where",
                          .target = &out_,
                          .required = true}}}}};

  std::string wall_;
  std::string note_;
  int coats_ = 2;
  double area_ = 12.5;
  std::int64_t seed_ = 1;
  std::optional<std::int64_t> id_;
  std::optional<double> limit_;
  Colour colour_ = Colour::kGreen;
  bool dry_ = false;
  bool coats_given_ = false;
  std::vector<std::string> floors_;
  std::string out_;
};

TEST_F(CommandLineTest, WhatIsNotGivenKeepsItsDefault) {
  const Invocation invocation = ParseWords(program_, {"wall", "north"});
  EXPECT_EQ(invocation.command, &program_.commands[0]);
  EXPECT_EQ(wall_, "north");
  EXPECT_EQ(note_, "");
  EXPECT_EQ(coats_, 2);
  EXPECT_EQ(area_, 12.5);
  EXPECT_EQ(seed_, 1);
  EXPECT_FALSE(id_ || limit_ || dry_ || coats_given_);
  EXPECT_EQ(colour_, Colour::kGreen);
}

TEST_F(CommandLineTest, EveryTypeOfTargetIsSet) {
  ParseWords(program_, {"wall", "--note", "-x", "--coats=3", "--area", "1e-3", "--id", "-7",
                        "--limit", "2.5", "--seed", "9000000000", "--colour", "red", "--dry", "w"});
  EXPECT_EQ(wall_, "w");
  EXPECT_EQ(note_, "-x");
  EXPECT_EQ(coats_, 3);
  EXPECT_TRUE(coats_given_);
  EXPECT_EQ(area_, 1e-3);
  EXPECT_EQ(id_, -7);
  EXPECT_EQ(limit_, 2.5);
  EXPECT_EQ(seed_, 9000000000);
  EXPECT_EQ(colour_, Colour::kRed);
  EXPECT_TRUE(dry_);
}

TEST_F(CommandLineTest, SeveralPositionalsComeBeforeOrAfterOptions) {
  const Invocation invocation = ParseWords(program_, {"floors", "1", "2", "--out", "x"});
  EXPECT_EQ(invocation.command, &program_.commands[1]);
  EXPECT_THAT(floors_, ElementsAre("1", "2"));
  ParseWords(program_, {"floors", "--out", "x", "3"});
  EXPECT_THAT(floors_, ElementsAre("3"));
}

TEST_F(CommandLineTest, AfterTwoDashesNothingIsAnOption) {
  ParseWords(program_, {"wall", "--", "--dry"});
  EXPECT_EQ(wall_, "--dry");
  EXPECT_FALSE(dry_);
}

TEST_F(CommandLineTest, HelpNamesUnitsDefaultsAndFooters) {
  const std::string text = ParseWords(program_, {"--help"}).answer;
  EXPECT_THAT(text, AllOf(HasSubstr("Paints."), HasSubstr("Paint floors"),
                          HasSubstr("Below the commands."), Not(HasSubstr("--coats"))));
  const std::string wall = ParseWords(program_, {"wall", "--help"}).answer;
  EXPECT_THAT(
      wall, AllOf(HasSubstr("WALL REQUIRED"), HasSubstr("--coats N=2"), HasSubstr("--area M2=12.5"),
                  HasSubstr("--id ID "), HasSubstr("{red,green}=green"),
                  HasSubstr("Below the options."), Not(HasSubstr("Below the commands."))));
  EXPECT_THAT(ParseWords(program_, {"floors", "-h"}).answer, HasSubstr("Below the commands."));
}

TEST_F(CommandLineTest, VersionIsOneLine) {
  const Invocation invocation = ParseWords(program_, {"--version"});
  EXPECT_EQ(invocation.command, nullptr);
  EXPECT_EQ(invocation.answer, "paint 1.2.3\n");
}

TEST_F(CommandLineTest, WithoutAnyWordTheAnswerIsTheHelp) {
  const Invocation invocation = ParseWords(program_, {});
  EXPECT_EQ(invocation.command, nullptr);
  EXPECT_TRUE(invocation.lacks_command);
  EXPECT_EQ(invocation.answer, ParseWords(program_, {"--help"}).answer);
  EXPECT_FALSE(ParseWords(program_, {"--help"}).lacks_command);
}

TEST_F(CommandLineTest, WhatMakesNoSenseIsRefusedAndPointsToTheHelpOfItsCommand) {
  EXPECT_THAT(UsageErrorOf(program_, {"--"}), HasSubstr("(see paint --help)"));
  const auto expect = [this](const std::vector<const char*>& words, const char* problem) {
    EXPECT_THAT(UsageErrorOf(program_, words),
                AllOf(HasSubstr(problem), HasSubstr("(see paint wall --help)")));
  };
  expect({"wall"}, "WALL is required");
  expect({"wall", "a", "b"}, "b");
  expect({"wall", "a", "--coats"}, "--coats");
  expect({"wall", "a", "--coats", "many"}, "--coats = many");
  expect({"wall", "a", "--coats", "1.5"}, "--coats = 1.5");
  expect({"wall", "a", "--coats", "1", "--coats", "2"}, "--coats");
  expect({"wall", "a", "--colour", "blue"}, "--colour: blue not in {red,green}");
  expect({"wall", "a", "--note", ""}, "--note: the name is empty");
  EXPECT_THAT(UsageErrorOf(program_, {"floors", "1"}), HasSubstr("--out is required"));
}

TEST_F(CommandLineTest, AMistypedCommandNamesTheNearestOne) {
  EXPECT_EQ(UsageErrorOf(program_, {"floor", "1"}),
            "there is no command 'floor'; did you mean floors? (see paint --help)");
  EXPECT_EQ(UsageErrorOf(program_, {"wlal"}),
            "there is no command 'wlal'; did you mean wall? (see paint --help)");
  EXPECT_EQ(UsageErrorOf(program_, {"ceiling"}),
            "there is no command 'ceiling' (see paint --help)");
  EXPECT_THAT(UsageErrorOf(program_, {"--versoin"}), HasSubstr("did you mean --version?"));
}

TEST_F(CommandLineTest, AMistypedOptionNamesTheNearestOne) {
  const auto suggestion = [this](const char* option) {
    return UsageErrorOf(program_, {"wall", "a", option, "3"});
  };
  EXPECT_EQ(suggestion("--caots"),
            "there is no option '--caots'; did you mean --coats? (see paint wall --help)");
  EXPECT_THAT(suggestion("--caots=3"), HasSubstr("'--caots'; did you mean --coats?"));
  EXPECT_THAT(suggestion("--color"), HasSubstr("did you mean --colour?"));
  EXPECT_THAT(suggestion("-coats"), HasSubstr("did you mean --coats?"));
  EXPECT_THAT(suggestion("--hlep"), HasSubstr("did you mean --help?"));
  EXPECT_EQ(suggestion("--temperature"),
            "there is no option '--temperature' (see paint wall --help)");
  // The wrong option is reported first, although an argument is missing too.
  EXPECT_THAT(UsageErrorOf(program_, {"floors", "--uot", "x"}), HasSubstr("did you mean --out?"));
}

TEST_F(CommandLineTest, TheValueOfAnOptionIsNotTakenForAnOption) {
  ParseWords(program_, {"wall", "a", "--note", "--caots"});
  EXPECT_EQ(note_, "--caots");
  EXPECT_THAT(UsageErrorOf(program_, {"wall", "a", "--dry", "--caots"}),
              HasSubstr("did you mean --coats?"));
}

TEST_F(CommandLineTest, ExecuteNamesTheOptionInMessagesOfTheLibrary) {
  Command command = program_.commands[0];
  const auto message = [&command](ErrorCode code, const char* text) -> std::string {
    command.action = [code, text] { throw Error(code, text); };
    try {
      Execute(command);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(ErrorCode::kUsage, "coats is 0, expected 1"), "--coats is 0, expected 1");
  EXPECT_EQ(message(ErrorCode::kInput, "coats is 0"), "coats is 0");
}

}  // namespace
}  // namespace loopgrid
