#include "apps/net/host_check.h"

#include <gtest/gtest.h>

namespace loopgrid {
namespace {

TEST(HostCheck, AcceptsNamesOfThisMachineOnLoopback) {
  const HostCheck check(true, "127.0.0.1");
  for (const char* host : {"localhost", "localhost:8080", "LOCALHOST", "127.0.0.1:1", "127.0.0.2:1",
                           "127.0.1.1", "[::1]:8080", "[::1]", "[::ffff:127.0.0.1]:80"}) {
    EXPECT_TRUE(check.Accepts(host)) << host;
  }
}

TEST(HostCheck, RefusesForeignNamesOnLoopback) {
  const HostCheck check(true, "robot");
  for (const char* host :
       {"", ":8080", "evil.example", "evil.example:8080", "localhost.evil.example",
        "127.0.0.1.evil.example", "evil.example:localhost", "[::2]", "128.0.0.1", "10.0.0.1:8080",
        "127.0.0.256", "robot.evil.example", "evil.robot", "robots", "[", "[]", "]:"}) {
    EXPECT_FALSE(check.Accepts(host)) << host;
  }
}

TEST(HostCheck, AcceptsTheNameThatItWasToldToBindTo) {
  const HostCheck check(true, "Robot.local");
  for (const char* host : {"robot.local:8080", "ROBOT.LOCAL", "localhost:8080", "127.0.1.1:8080"}) {
    EXPECT_TRUE(check.Accepts(host)) << host;
  }
  EXPECT_TRUE(HostCheck(true, "::1").Accepts("[::1]:8080"));
  EXPECT_FALSE(HostCheck(true, "").Accepts(""));
}

TEST(HostCheck, AcceptsAllNamesWhereOtherMachinesReachIt) {
  EXPECT_TRUE(HostCheck(false, "0.0.0.0").Accepts("robot.example"));
}

}  // namespace
}  // namespace loopgrid
