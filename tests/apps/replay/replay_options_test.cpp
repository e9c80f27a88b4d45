#include "apps/replay/replay_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using ::testing::HasSubstr;

std::string Problem(const std::function<void(ReplayOptions*)>& change) {
  ReplayOptions options;
  change(&options);
  try {
    options.Validate();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    return error.what();
  }
  return "";
}

TEST(ReplayOptions, DefaultsAndBoundsAreFine) {
  EXPECT_EQ(Problem([](ReplayOptions*) {}), "");
  for (const double speed : {0.0, 1e-6, 1e6}) {
    EXPECT_EQ(Problem([=](ReplayOptions* options) { options->speed = speed; }), "");
  }
  EXPECT_EQ(Problem([](ReplayOptions* options) { options->loop = 0; }), "");
  EXPECT_EQ(Problem([](ReplayOptions* options) { options->to = "[::1]:65535"; }), "");
}

TEST(ReplayOptions, WhatIsOutOfBoundsIsNamed) {
  for (const double speed :
       {-1.0, 1e-7, 1e7, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(Problem([=](ReplayOptions* options) { options->speed = speed; }),
                HasSubstr("--speed is "));
  }
  EXPECT_THAT(Problem([](ReplayOptions* options) { options->loop = -1; }), HasSubstr("loop is -1"));
  EXPECT_THAT(Problem([](ReplayOptions* options) { options->from_line = 0; }),
              HasSubstr("from-line is 0"));
  EXPECT_THAT(Problem([](ReplayOptions* options) { options->to = "robot"; }),
              HasSubstr("is not HOST:PORT"));
  EXPECT_THAT(Problem([](ReplayOptions* options) { options->to = "robot:0"; }),
              HasSubstr("to is robot:0"));
}

}  // namespace
}  // namespace loopgrid
