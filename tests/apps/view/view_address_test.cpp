#include "apps/view/view_address.h"

#include <gtest/gtest.h>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

TEST(ViewAddress, IsAPortOrAHostAndAPort) {
  EXPECT_EQ(ParseViewAddress("8080").host, "127.0.0.1");
  EXPECT_EQ(ParseViewAddress("8080").port, 8080);
  EXPECT_EQ(ParseViewAddress("0.0.0.0:80").host, "0.0.0.0");
  EXPECT_EQ(ParseViewAddress("0.0.0.0:80").port, 80);
  EXPECT_EQ(ParseViewAddress("[::1]:8080").host, "::1");
  for (const char* nonsense : {"", "x", "70000", "-1", "localhost", "localhost:", ":80", "1.5",
                               "host:port", "host:70000"}) {
    EXPECT_THROW(ParseViewAddress(nonsense), Error) << nonsense;
  }
}

TEST(ViewAddress, HasAPortThatExists) {
  EXPECT_EQ(ParseViewAddress("0").port, 0);
  EXPECT_EQ(ParseViewAddress("65535").port, 65535);
  EXPECT_NO_THROW(RequireViewPort(0));
  EXPECT_NO_THROW(RequireViewPort(65535));
  for (const int port : {-1, 65536}) EXPECT_THROW(RequireViewPort(port), Error) << port;
}

}  // namespace
}  // namespace loopgrid
