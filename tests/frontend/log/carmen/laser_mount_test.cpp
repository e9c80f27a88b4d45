#include "frontend/log/carmen/laser_mount.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace loopgrid {
namespace {

const SE2 kFallback(0.0, 0.0, 3.0);
const SE2 kMount(0.2, -0.1, 0.3);

// A robot that drives a curve: 2 cm and 0.02 rad from scan to scan.
SE2 Driven(int scan) {
  SE2 pose(5.0, -3.0, 1.0);
  for (int i = 0; i < scan; ++i) pose = pose.Boxplus({0.02, 0.0, 0.02});
  return pose;
}

void ExpectSameMount(const SE2& a, const SE2& b) {
  EXPECT_LT(a.Boxminus(b).cwiseAbs().maxCoeff(), 1e-9) << a.coordinates().transpose();
}

TEST(LaserMount, EqualPosesMeanTheFallbackAtOnce) {
  LaserMount mount(kFallback);
  mount.Add(Driven(0), Driven(0));
  EXPECT_TRUE(mount.decided());
  ExpectSameMount(mount.T_robot_laser(), kFallback);
}

TEST(LaserMount, IsProvenByAConstantDifferenceOnceTheRobotHasDrivenAndTurned) {
  LaserMount mount(kFallback);
  int scan = 0;
  for (; !mount.decided() && scan < 100; ++scan) mount.Add(Driven(scan) * kMount, Driven(scan));
  EXPECT_GE(scan, 10);
  EXPECT_LE(scan, 13);
  ExpectSameMount(mount.T_robot_laser(), kMount);
}

TEST(LaserMount, NeitherDrivingNorTurningAloneProvesIt) {
  LaserMount driving(kFallback);
  LaserMount turning(kFallback);
  for (int i = 0; i < 100; ++i) {
    const SE2 ahead(0.1 * i, 0.0, 0.0);
    driving.Add(ahead * kMount, ahead);
    const SE2 turned(0.0, 0.0, 0.1 * i);
    turning.Add(turned * kMount, turned);
  }
  EXPECT_FALSE(driving.decided());
  EXPECT_FALSE(turning.decided());
}

TEST(LaserMount, AnotherMappersCorrectionsAreNoMount) {
  for (const SE2& T_map_odom : {SE2(0.5, 0.2, 0.0), SE2(0.0, 0.0, 0.4), SE2(-0.3, 0.1, 0.2)}) {
    LaserMount mount(kFallback);
    for (int i = 0; i < 60 && !mount.decided(); ++i) {
      const SE2 T_odom_robot = SE2().Boxplus({0.05 * i, 0.0, 0.05 * i});
      mount.Add(T_map_odom * T_odom_robot, T_odom_robot);
    }
    EXPECT_TRUE(mount.decided());
    ExpectSameMount(mount.T_robot_laser(), kFallback);
  }
}

TEST(LaserMount, NoRobotIsThatLarge) {
  LaserMount mount(kFallback);
  mount.Add(Driven(0) * SE2(2.5, 0.0, 0.0), Driven(0));
  EXPECT_TRUE(mount.decided());
  ExpectSameMount(mount.T_robot_laser(), kFallback);
}

TEST(LaserMount, ToleratesRoundedNumbers) {
  const auto rounded = [](const SE2& pose) {
    const auto round = [](double number) { return std::round(number * 1e3) / 1e3; };
    return SE2(round(pose.x()), round(pose.y()), round(pose.theta()));
  };
  LaserMount mount(kFallback);
  for (int i = 0; i < 30; ++i) mount.Add(rounded(Driven(i) * kMount), rounded(Driven(i)));
  EXPECT_TRUE(mount.decided());
  EXPECT_LT(mount.T_robot_laser().Boxminus(kMount).cwiseAbs().maxCoeff(), 3e-3);
}

TEST(LaserMount, StandingStillForLongSettlesForTheDifference) {
  LaserMount mount(kFallback);
  int messages = 0;
  while (!mount.decided() && messages < 10'000) {
    mount.Add(Driven(3) * kMount, Driven(3));
    ++messages;
  }
  EXPECT_LE(messages, 1'000);
  ExpectSameMount(mount.T_robot_laser(), kMount);
}

TEST(LaserMount, TheEndOfTheLogSettlesForTheDifference) {
  LaserMount mount(kFallback);
  mount.Add(Driven(0) * kMount, Driven(0));
  EXPECT_FALSE(mount.decided());
  mount.Decide();
  EXPECT_TRUE(mount.decided());
  ExpectSameMount(mount.T_robot_laser(), kMount);
}

TEST(LaserMount, WithoutAnyMessageIsTheFallback) {
  LaserMount mount(kFallback);
  mount.Decide();
  ExpectSameMount(mount.T_robot_laser(), kFallback);
}

TEST(LaserMount, CanBeSet) {
  LaserMount mount(kFallback);
  mount.Add(Driven(0) * kMount, Driven(0));
  mount.Set(SE2(1.0, 0.0, 0.0));
  EXPECT_TRUE(mount.decided());
  ExpectSameMount(mount.T_robot_laser(), SE2(1.0, 0.0, 0.0));
}

}  // namespace
}  // namespace loopgrid
