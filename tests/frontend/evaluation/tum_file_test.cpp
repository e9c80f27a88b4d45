#include "frontend/evaluation/tum_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "backend/base/error.h"
#include "tests/support/memory_file.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(TumFile, RoundTripKeepsOrderTimesAndPoses) {
  const test_support::TemporaryDirectory directory;
  Trajectory trajectory;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const double time = 976052857.767368 + 10.0 * uniform(random);  // in no order
    trajectory.push_back({time, SE2(1e3 * uniform(random), 1e3 * uniform(random),
                                    std::numbers::pi * uniform(random))});
  }
  trajectory.push_back({0.0, SE2(0.0, 0.0, -std::numbers::pi)});
  const std::string path = directory.File("trajectory.tum");
  WriteTumFile(path, trajectory);
  const Trajectory read = ReadTumFile(path);
  ASSERT_EQ(read.size(), trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(read[i].timestamp, trajectory[i].timestamp, 6e-7);
    EXPECT_LT(read[i].pose.Boxminus(trajectory[i].pose).cwiseAbs().maxCoeff(), 2e-6) << i;
  }
}

TEST(TumFile, WritesEightNumbersALine) {
  const test_support::TemporaryDirectory directory;
  const std::string path = directory.File("trajectory.tum");
  WriteTumFile(path, {{976052857.767368, SE2(1.5, -2.0, std::numbers::pi / 2.0)}});
  EXPECT_EQ(test_support::ReadFile(path),
            "976052857.767368 1.500000 -2.000000 0 0 0 0.707106781 0.707106781\n");
}

TEST(TumFile, KeepsTheYawOfARotationInSpace) {
  const double yaw = 2.5;
  const Eigen::Quaterniond tilted(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitX()));
  for (const double sign : {1.0, -1.0}) {  // a quaternion and its negative are one rotation
    std::string line = "1 2 3 4";
    for (const double number : {tilted.x(), tilted.y(), tilted.z(), tilted.w()}) {
      line += fmt::format(" {:.6f}", sign * number);
    }
    const MemoryFile file(line + "\n");
    EXPECT_NEAR(ReadTumFile(file.path()).at(0).pose.theta(), yaw, 1e-5);
  }
}

TEST(TumFile, NormalisesQuaternionsOfNearlyUnitNorm) {
  for (const double norm : {0.9001, 0.99, 1.0, 1.0999}) {
    const MemoryFile file(fmt::format("1 2 3 0 0 0 {} {}\n", 0.6 * norm, 0.8 * norm));
    EXPECT_NEAR(ReadTumFile(file.path()).at(0).pose.theta(), 2.0 * std::asin(0.6), 1e-12) << norm;
  }
  const MemoryFile file("1 0 0 0 0 0 0.7 0.7\n");
  EXPECT_NEAR(ReadTumFile(file.path()).at(0).pose.theta(), 0.5 * std::numbers::pi, 1e-12);
  for (const char* w : {"0.8999", "1.1001", "-0.5"}) {
    const MemoryFile far(fmt::format("# pose\n1 0 0 0 0 0 0 {}\n", w));
    EXPECT_THAT([&] { ReadTumFile(far.path()); },
                ThrowsMessage<Error>(HasSubstr(far.path() + ":2: the quaternion's norm is ")));
  }
}

TEST(TumFile, RefusesMalformedFilesWithTheLine) {
  const struct {
    const char* content;
    const char* problem;
  } cases[] = {
      {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n", ":2: expected 8 numbers, found 7"},
      {"1 0 0 0 0 0 nan 1\n", ":1: field 7 is not a finite number"},
      {"1 0 0 0 0 0 0 0\n", ":1: the quaternion's norm is 0, not 1"},
      {"1 0 0 0 0 0 1 1\n", ":1: the quaternion's norm is 1.41421, not 1"},
      {"1 0 0 0 1e300 1e300 0 0\n", ":1: the quaternion's norm is 1.41421e+300, not 1"},
      {"1 1e9 0 0 0 0 0 1\n", ":1: the pose is out of any bounds"},
      {"", ": holds no pose"},
      {"# nothing\n", ": holds no pose"},
  };
  for (const auto& [content, problem] : cases) {
    const MemoryFile file(content);
    EXPECT_THAT([&] { ReadTumFile(file.path()); }, ThrowsMessage<Error>(file.path() + problem));
  }
}

TEST(TumFile, SaysWhenItCannotBeWritten) {
  const Trajectory trajectory(1);
  EXPECT_THAT([&] { WriteTumFile("/dev/full", trajectory); },
              ThrowsMessage<Error>(HasSubstr("/dev/full: ")));
}

}  // namespace
}  // namespace loopgrid
