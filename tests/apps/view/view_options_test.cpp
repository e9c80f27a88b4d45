#include "apps/view/view_options.h"

#include <gtest/gtest.h>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

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
