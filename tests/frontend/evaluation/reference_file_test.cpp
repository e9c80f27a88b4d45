#include "frontend/evaluation/reference_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "backend/base/error.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::ThrowsMessage;

ReferenceKind GuessOf(const std::string& text) {
  const MemoryFile file(text);
  return GuessReferenceKind(ReadNumberTable(file.path()));
}

TEST(GuessReferenceKind, KnowsTrajectoriesWithRoundedQuaternions) {
  const char* trajectories[] = {
      "10 0 0 0 0 0 0.7 0.7\n",                                      // norm 0.99
      "10 0 0 0 0 0 0 1\n11 1 0 0 0 0 0 -1\n",                       // no rotation
      "10 0 0 0 0 0 0 1.001\n11 0 0 0 0 0 .1 1\n",                   // rounded
      "10 0 0 1 0.5 0.5 0.5 0.5\n",                                  // in space
      "10 0 0 0 0 0 0.7 0.7\n11 0 0 0 0 0 1 0\n12 0 0 0 0 0 0 0\n",  // the last one is broken
  };
  for (const char* text : trajectories) {
    EXPECT_EQ(GuessOf(text), ReferenceKind::kTrajectory) << text;
  }
}

TEST(GuessReferenceKind, KnowsRelations) {
  const char* relations[] = {
      "10 11 1 0 0 0 0 0\n",
      "10 11 1 0 0 0 0 0.95\n11 12 1 0 0 0 0 1.05\n",        // yaw of nearly 1
      "10 11 1 0 0 0 0 1\n11 12 1 0 0 0 0 0.2\n",            // one yaw of exactly 1
      "976052905 976052911 1 0 0 0 0 1\n",                   // no position is so far away
      "10 11 1 0 0 0.1 0.2 0.3\n11 12 1 0 0 0.6 0.8 0.1\n",  // in space
      "",
  };
  for (const char* text : relations) {
    EXPECT_EQ(GuessOf(text), ReferenceKind::kRelations) << text;
  }
}

TEST(GuessReferenceKind, IsRightForRandomFilesOfBothKinds) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    std::string trajectory;
    std::string relations;
    for (int i = 0; i < 20; ++i) {
      const double angle = std::numbers::pi * uniform(random);
      trajectory += fmt::format("{} {:.2f} {:.2f} 0 0 0 {:.2f} {:.2f}\n", i, 50 * uniform(random),
                                50 * uniform(random), std::sin(angle / 2), std::cos(angle / 2));
      relations += fmt::format("{} {} {:.2f} {:.2f} 0 0 0 {:.2f}\n", i, i + 5, uniform(random),
                               uniform(random), angle);
    }
    EXPECT_EQ(GuessOf(trajectory), ReferenceKind::kTrajectory) << "trial " << trial;
    EXPECT_EQ(GuessOf(relations), ReferenceKind::kRelations) << "trial " << trial;
  }
}

TEST(ReadReference, ReadsWhatItSeemsToBeUnlessTold) {
  const MemoryFile file("10 11 1 0 0 0 0 1\n");
  EXPECT_EQ(std::get<Trajectory>(ReadReference(file.path(), std::nullopt)).at(0).pose.x(), 11.0);
  const auto relations =
      std::get<std::vector<Relation>>(ReadReference(file.path(), ReferenceKind::kRelations));
  EXPECT_EQ(relations.at(0).t2, 11.0);
  EXPECT_EQ(relations.at(0).T_1_2.theta(), 1.0);
}

TEST(ReadReference, RefusesWhatIsNotOfTheKindThatItIsToldOrSeemsToBe) {
  const MemoryFile relations("10 11 1 0 0 0 0 0.2\n");
  EXPECT_THAT([&] { ReadReference(relations.path(), ReferenceKind::kTrajectory); },
              ThrowsMessage<Error>(relations.path() + ":1: the quaternion's norm is 0.2, not 1"));
  const MemoryFile broken(
      "10 0 0 0 0 0 0.7 0.7\n11 0 0 0 0 0 1 0\n\n12 0 0 0 0 0 0.5 0.5\n13 0 0 0 0 0 0 1\n");
  EXPECT_THAT([&] { ReadReference(broken.path(), std::nullopt); },
              ThrowsMessage<Error>(broken.path() + ":4: the quaternion's norm is 0.707107, not 1"));
}

}  // namespace
}  // namespace loopgrid
