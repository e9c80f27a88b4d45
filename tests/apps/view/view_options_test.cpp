#include "apps/view/view_options.h"

#include <gtest/gtest.h>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

TEST(ViewServerOptions, AreReadFromAnAddress) {
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

TEST(ViewServerOptions, AreRefusedOutOfRange) {
  const auto is_refused = [](auto change) {
    ViewServerOptions options;
    change(&options);
    try {
      options.Validate();
    } catch (const Error& error) {
      return error.code() == ErrorCode::kUsage;
    }
    return false;
  };
  EXPECT_NO_THROW(ViewServerOptions().Validate());
  EXPECT_TRUE(is_refused([](ViewServerOptions* options) { options->host = ""; }));
  EXPECT_TRUE(is_refused([](ViewServerOptions* options) { options->port = 65536; }));
  EXPECT_TRUE(is_refused([](ViewServerOptions* options) { options->max_connections = 0; }));
  EXPECT_TRUE(is_refused([](ViewServerOptions* options) { options->request_timeout = 0.0; }));
  EXPECT_TRUE(is_refused([](ViewServerOptions* options) { options->write_timeout = 1e9; }));
  EXPECT_TRUE(is_refused([](ViewServerOptions* options) { options->batch_interval = 0.0; }));
  EXPECT_TRUE(is_refused([](ViewServerOptions* options) { options->max_backlog = 0; }));
}

}  // namespace
}  // namespace loopgrid
