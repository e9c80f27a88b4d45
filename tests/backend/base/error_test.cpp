#include "backend/base/error.h"

#include <gtest/gtest.h>

namespace loopgrid {
namespace {

TEST(Error, CarriesItsCodeAndMessage) {
  const Error error(ErrorCode::kOutput, "map.png: cannot write");
  EXPECT_EQ(error.code(), ErrorCode::kOutput);
  EXPECT_STREQ(error.what(), "map.png: cannot write");
}

}  // namespace
}  // namespace loopgrid
