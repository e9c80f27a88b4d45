#include "apps/settings/mapping_options.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "backend/base/error.h"
#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

using test_support::ParseArguments;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

Command CommandWith(RunOptions* options, std::set<std::string>* given) {
  return {.name = "map", .arguments = MappingArguments(options, given)};
}

TEST(MappingOptions, EveryOneReachesItsFieldAndIsNoted) {
  RunOptions options;
  std::set<std::string> given;
  const Command command = CommandWith(&options, &given);
  ParseArguments(command, {});
  EXPECT_TRUE(given.empty());
  for (const MappingOption& option : MappingOptions()) {
    if (option.number == nullptr) {
      EXPECT_FALSE(option.flag(options));
      ParseArguments(command, {option.name});
      EXPECT_TRUE(option.flag(options)) << option.name;
    } else {
      ParseArguments(command, {option.name, "0.625"});
      EXPECT_EQ(option.number(options), 0.625) << option.name;
    }
    EXPECT_TRUE(given.contains(option.key));
  }
  EXPECT_EQ(given.size(), MappingOptions().size()) << "two options have the same key";
  EXPECT_EQ(options.resolution, 0.625);
  EXPECT_EQ(options.slam.node_distance, 0.625);
  EXPECT_EQ(options.slam.node_angle, 0.625);
  EXPECT_TRUE(options.strict);
}

TEST(MappingOptions, BoundsAreAcceptedAndWhatIsBeyondIsNamed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(RunOptions().Validate());
  for (const MappingOption& option : MappingOptions()) {
    if (option.number == nullptr) continue;
    RunOptions options;
    for (const double value : {option.least, option.most}) {
      option.number(options) = value;
      EXPECT_NO_THROW(options.Validate()) << option.name << ' ' << value;
    }
    for (const double value :
         {std::nextafter(option.least, -kInfinity), std::nextafter(option.most, kInfinity), -1.0,
          0.0, kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
      option.number(options) = value;
      EXPECT_THAT([&] { options.Validate(); },
                  ThrowsMessage<Error>(AllOf(
                      StartsWith(fmt::format("{} is {}, ", option.name, value)),
                      HasSubstr(fmt::format("expected {} to {}", option.least, option.most)))));
    }
  }
}

TEST(MappingOptions, TheLibrarysOwnBoundsAreTheSame) {
  for (const MappingOption& option : MappingOptions()) {
    if (option.number == nullptr || std::string(option.key) == "resolution") continue;
    RunOptions options;
    option.number(options) = option.most;
    EXPECT_NO_THROW(options.slam.Validate());
    option.number(options) = std::nextafter(option.most, 1e9);
    EXPECT_THROW(options.slam.Validate(), Error) << option.name;
    option.number(options) = std::nextafter(option.least, 0.0);
    EXPECT_THROW(options.slam.Validate(), Error) << option.name;
  }
}

TEST(MappingOptions, HelpNamesUnitBoundsAndDefault) {
  RunOptions options;
  for (const Argument& argument : MappingArguments(&options, nullptr)) {
    if (argument.name != "--node-distance") continue;
    EXPECT_EQ(argument.unit, "METRES");
    EXPECT_TRUE(argument.shows_default);
    EXPECT_THAT(argument.help, HasSubstr("0.05 to 10 metres"));
    return;
  }
  ADD_FAILURE() << "there is no --node-distance";
}

}  // namespace
}  // namespace loopgrid
