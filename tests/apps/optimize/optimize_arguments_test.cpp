#include "apps/optimize/optimize_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

using test_support::UsageErrorOf;
using ::testing::HasSubstr;

OptimizeOptions ParseOptimize(const std::vector<const char*>& words) {
  OptimizeOptions options;
  test_support::ParseArguments(DescribeOptimize(&options), words);
  return options;
}

TEST(OptimizeArguments, TakeAGraphAndHaveDefaultsForAllElse) {
  const OptimizeOptions options = ParseOptimize({"a.g2o"});
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

TEST(OptimizeArguments, ReachTheirFields) {
  const OptimizeOptions options = ParseOptimize({"a.g2o",       "--out",
                                                 "o",           "--picture",
                                                 "p.png",       "--trace",
                                                 "t",           "--marginals",
                                                 "m",           "--relative-to",
                                                 "-7",          "--method",
                                                 "dogleg",      "--parametrization",
                                                 "exponential", "--init",
                                                 "chordal",     "--loss",
                                                 "gnc",         "--loss-width",
                                                 "2.5",         "--robust",
                                                 "all",         "--max-iterations",
                                                 "7",           "--tolerance",
                                                 "1e-3",        "--threads",
                                                 "2",           "--lenient",
                                                 "--json",      "--quiet"});
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

TEST(OptimizeArguments, EveryWordOfAChoiceIsUnderstood) {
  const auto parse = [](const char* option, std::string_view word) {
    const std::string text(word);
    return ParseOptimize({"a", option, text.c_str()});
  };
  for (const auto& [name, value] : kMethods) EXPECT_EQ(parse("--method", name).method, value);
  for (const auto& [name, value] : kParametrizations) {
    EXPECT_EQ(parse("--parametrization", name).parametrization, value);
  }
  for (const auto& [name, value] : kInitialGuesses) EXPECT_EQ(parse("--init", name).init, value);
  for (const auto& [name, value] : kLosses) EXPECT_EQ(parse("--loss", name).loss, value);
  for (const auto& [name, value] : kRobustSets) EXPECT_EQ(parse("--robust", name).robust, value);
  OptimizeOptions options;
  for (const char* option : {"--method", "--parametrization", "--init", "--loss", "--robust"}) {
    EXPECT_THAT(UsageErrorOf(DescribeOptimize(&options), {"a", option, "best"}),
                ::testing::AllOf(HasSubstr(option), HasSubstr("best")));
  }
}

TEST(OptimizeOptions, EulerAnglesStartAtThePosesInTheFileUnlessToldNotTo) {
  OptimizeOptions options;
  EXPECT_EQ(options.Start(), InitialGuess::kAuto);
  options.parametrization = Parametrization::kEuler;
  EXPECT_EQ(options.Start(), InitialGuess::kNone);
  options.init = InitialGuess::kChordal;
  EXPECT_EQ(options.Start(), InitialGuess::kChordal);
}

}  // namespace
}  // namespace loopgrid
