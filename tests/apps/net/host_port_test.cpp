#include "apps/net/host_port.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using ::testing::HasSubstr;

TEST(HostPort, IsReadAndWrittenTheSameWay) {
  for (const char* text : {"127.0.0.1:7070", "robot:1", "a.b-c.example:65535", "[::1]:0",
                           "[fe80::1%eth0]:80", "0.0.0.0:8080"}) {
    EXPECT_EQ(ToString(ParseHostPort(text)), text);
  }
  const HostPort address = ParseHostPort("[::1]:7070");
  EXPECT_EQ(address.host, "::1");
  EXPECT_EQ(address.port, 7070);
}

TEST(HostPort, AnythingElseIsWrongUsage) {
  for (const char* text :
       {"", ":", "robot", "robot:", ":7070", "robot:65536", "robot:-1", "robot:7x", "robot:7 ",
        "::1:7070", "[]:7070", "[::1]", "a b:1", "[a:1", "a\nb:1", "robot:4294967376"}) {
    try {
      ParseHostPort(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUsage) << text;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

TEST(HostPort, LoopbackIsWhatOnlyThisMachineReaches) {
  for (const char* host :
       {"localhost", "127.0.0.1", "127.255.0.3", "::1", "0:0:0:0:0:0:0:1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(IsLoopback(host)) << host;
  }
  for (const char* host : {"0.0.0.0", "::", "128.0.0.1", "10.127.0.1", "robot", "localhost.example",
                           "127.0.0.1.example", "::ffff:10.0.0.1", "127", ""}) {
    EXPECT_FALSE(IsLoopback(host)) << host;
  }
}

}  // namespace
}  // namespace loopgrid
