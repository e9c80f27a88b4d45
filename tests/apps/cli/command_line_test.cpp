#include "apps/cli/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
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

TEST(CommandLine, ReplayTakesALogAndEveryOptionReachesItsField) {
  const auto plain = std::get<ReplayOptions>(Parse({"replay", "a.clf"}));
  EXPECT_EQ(plain.log, "a.clf");
  EXPECT_EQ(plain.speed, 1.0);
  EXPECT_EQ(plain.to, "");
  EXPECT_EQ(plain.loop, 1);
  EXPECT_EQ(plain.from_line, 1);
  const auto replay =
      std::get<ReplayOptions>(Parse({"replay", "a.clf", "--speed", "10", "--to", "robot:7070",
                                     "--loop", "0", "--from-line", "20"}));
  EXPECT_EQ(replay.speed, 10.0);
  EXPECT_EQ(replay.to, "robot:7070");
  EXPECT_EQ(replay.loop, 0);
  EXPECT_EQ(replay.from_line, 20);
}

TEST(CommandLine, OnlineTakesAFolderAndHasDefaultsForAllElse) {
  const auto online = std::get<OnlineOptions>(Parse({"online", "--out", "a"}));
  EXPECT_EQ(online.run.out, "a");
  for (const std::string* option : {&online.follow, &online.listen, &online.connect, &online.resume,
                                    &online.continued, &online.view, &online.events}) {
    EXPECT_EQ(*option, "");
  }
  EXPECT_FALSE(online.once || online.run.strict || online.run.quiet);
  EXPECT_EQ(online.interval, 5.0);
  EXPECT_EQ(online.threads, 2);
  EXPECT_TRUE(online.given.empty());
  EXPECT_NO_THROW(online.Validate());
}

TEST(CommandLine, EveryOptionOfOnlineReachesItsField) {
  const auto online = std::get<OnlineOptions>(
      Parse({"online",          "--listen", "h:1",          "--once", "--out",        "a",
             "--continue",      "b",        "--view",       "8080",   "--events",     "-",
             "--interval",      "2",        "--threads",    "1",      "--resolution", "0.1",
             "--node-distance", "0.7",      "--node-angle", "0.3",    "--strict",     "--quiet"}));
  EXPECT_EQ(online.listen, "h:1");
  EXPECT_TRUE(online.once && online.run.strict && online.run.quiet);
  EXPECT_EQ(online.continued, "b");
  EXPECT_EQ(online.view, "8080");
  EXPECT_EQ(online.events, "-");
  EXPECT_EQ(online.interval, 2.0);
  EXPECT_EQ(online.threads, 1);
  EXPECT_EQ(online.run.resolution, 0.1);
  EXPECT_EQ(online.run.slam.node_distance, 0.7);
  EXPECT_EQ(online.run.slam.node_angle, 0.3);
  EXPECT_THAT(online.given, ::testing::UnorderedElementsAre("resolution", "node_distance",
                                                            "node_angle", "strict"));
  EXPECT_EQ(std::get<OnlineOptions>(Parse({"online", "--follow", "f", "--out", "a"})).follow, "f");
  EXPECT_EQ(std::get<OnlineOptions>(Parse({"online", "--connect", "c:2", "--out", "a"})).connect,
            "c:2");
  EXPECT_EQ(std::get<OnlineOptions>(Parse({"online", "--resume", "r"})).resume, "r");
}

TEST(CommandLine, EvalTakesTwoFiles) {
  const auto eval = std::get<EvalOptions>(Parse({"eval", "a.tum", "b.relations", "--json"}));
  EXPECT_EQ(eval.estimate, "a.tum");
  EXPECT_EQ(eval.reference, "b.relations");
  EXPECT_TRUE(eval.json);
}

TEST(CommandLine, OptimizeTakesAGraphAndHasDefaultsForAllElse) {
  const auto options = std::get<OptimizeOptions>(Parse({"optimize", "a.g2o"}));
  EXPECT_EQ(options.graph, "a.g2o");
  for (const std::string* output :
       {&options.out, &options.picture, &options.trace, &options.marginals}) {
    EXPECT_EQ(*output, "");
  }
  EXPECT_EQ(options.method, Method::kLevenbergMarquardt);
  EXPECT_EQ(options.parametrization, Parametrization::kManifold);
  EXPECT_EQ(options.init, InitialGuess::kAuto);
  EXPECT_EQ(options.loss, LossChoice::kNone);
  EXPECT_EQ(options.Loss().kind, LossKind::kQuadratic);
  EXPECT_FALSE(options.relative_to || options.loss_width || options.robust);
  EXPECT_GE(options.threads, 1);
  EXPECT_FALSE(options.lenient || options.json || options.quiet);
  EXPECT_NO_THROW(options.Validate());
}

TEST(CommandLine, EveryOptionOfOptimizeReachesItsField) {
  const auto options = std::get<OptimizeOptions>(Parse({"optimize",
                                                        "a.g2o",
                                                        "--out",
                                                        "o",
                                                        "--picture",
                                                        "p.png",
                                                        "--trace",
                                                        "t",
                                                        "--marginals",
                                                        "m",
                                                        "--relative-to",
                                                        "-7",
                                                        "--method",
                                                        "dogleg",
                                                        "--parametrization",
                                                        "exponential",
                                                        "--init",
                                                        "chordal",
                                                        "--loss",
                                                        "gnc",
                                                        "--loss-width",
                                                        "2.5",
                                                        "--robust",
                                                        "all",
                                                        "--max-iterations",
                                                        "7",
                                                        "--tolerance",
                                                        "1e-3",
                                                        "--threads",
                                                        "2",
                                                        "--lenient",
                                                        "--json",
                                                        "--quiet"}));
  EXPECT_EQ(options.out, "o");
  EXPECT_EQ(options.picture, "p.png");
  EXPECT_EQ(options.trace, "t");
  EXPECT_EQ(options.marginals, "m");
  EXPECT_EQ(options.relative_to, -7);
  EXPECT_EQ(options.init, InitialGuess::kChordal);
  EXPECT_EQ(options.robust, RobustSet::kAll);
  EXPECT_TRUE(options.lenient && options.json && options.quiet);
  EXPECT_NO_THROW(options.Validate());
  const OptimizerOptions solver = options.Solver();
  EXPECT_EQ(solver.method, Method::kDogLeg);
  EXPECT_EQ(solver.parametrization, Parametrization::kExponential);
  EXPECT_EQ(solver.loss.kind, LossKind::kGemanMcClure);
  EXPECT_EQ(solver.loss.width, 2.5);
  EXPECT_TRUE(solver.graduated);
  EXPECT_TRUE(solver.trace);
  EXPECT_EQ(solver.max_iterations, 7);
  EXPECT_EQ(solver.relative_decrease, 1e-3);
  EXPECT_EQ(solver.threads, 2);
}

TEST(CommandLine, EveryWordOfAChoiceIsUnderstood) {
  const auto parse = [](const char* option, std::string_view word) {
    const std::string text(word);
    return std::get<OptimizeOptions>(Parse({"optimize", "a", option, text.c_str()}));
  };
  for (const auto& [name, value] : kMethods) EXPECT_EQ(parse("--method", name).method, value);
  for (const auto& [name, value] : kParametrizations) {
    EXPECT_EQ(parse("--parametrization", name).parametrization, value);
  }
  for (const auto& [name, value] : kInitialGuesses) EXPECT_EQ(parse("--init", name).init, value);
  for (const auto& [name, value] : kLosses) EXPECT_EQ(parse("--loss", name).loss, value);
  for (const auto& [name, value] : kRobustSets) EXPECT_EQ(parse("--robust", name).robust, value);
  for (const char* option : {"--method", "--parametrization", "--init", "--loss", "--robust"}) {
    EXPECT_THAT(UsageError({"optimize", "a", option, "best"}),
                ::testing::AllOf(HasSubstr(option), HasSubstr("best")));
  }
}

TEST(CommandLine, EulerAnglesStartAtThePosesInTheFileUnlessToldNotTo) {
  OptimizeOptions options;
  EXPECT_EQ(options.Start(), InitialGuess::kAuto);
  options.parametrization = Parametrization::kEuler;
  EXPECT_EQ(options.Start(), InitialGuess::kNone);
  options.init = InitialGuess::kChordal;
  EXPECT_EQ(options.Start(), InitialGuess::kChordal);
}

TEST(CommandLine, PlotTakesTracesAndAPicture) {
  const auto plot =
      std::get<PlotOptions>(Parse({"plot", "a.csv", "b.csv", "c.csv", "--out", "all.png"}));
  EXPECT_THAT(plot.traces, ::testing::ElementsAre("a.csv", "b.csv", "c.csv"));
  EXPECT_EQ(plot.out, "all.png");
  EXPECT_THAT(std::get<PlotOptions>(Parse({"plot", "--out", "b.png", "a.csv"})).traces,
              ::testing::ElementsAre("a.csv"));
}

TEST(CommandLine, VersionIsOneLine) {
  const std::string text = std::get<Answer>(Parse({"--version"})).text;
  EXPECT_THAT(text, ::testing::MatchesRegex("loopgrid [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(CommandLine, HelpOfTheProgramNamesItsCommands) {
  const std::string text = std::get<Answer>(Parse({"--help"})).text;
  EXPECT_THAT(text, HasSubstr("run "));
  EXPECT_THAT(text, HasSubstr("eval "));
  EXPECT_THAT(text, HasSubstr("optimize "));
  EXPECT_THAT(text, HasSubstr("plot "));
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
