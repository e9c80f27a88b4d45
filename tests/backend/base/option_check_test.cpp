#include "backend/base/option_check.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

std::string RefusalOfValue(double value) {
  try {
    RequireBetween("some_field", value, 0.05, 10.0);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    return error.what();
  }
  return {};
}

TEST(RequireBetween, LetsTheBoundsAndAllBetweenThemPass) {
  for (double value : {0.05, 0.3, 10.0}) EXPECT_EQ(RefusalOfValue(value), "") << value;
}

TEST(RequireBetween, NamesFieldValueAndBounds) {
  EXPECT_EQ(RefusalOfValue(0.049), "some_field is 0.049, expected 0.05 to 10");
  EXPECT_EQ(RefusalOfValue(-1.0), "some_field is -1, expected 0.05 to 10");
  EXPECT_EQ(RefusalOfValue(1e300), "some_field is 1e+300, expected 0.05 to 10");
}

TEST(RequireBetween, RefusesWhatIsNoNumber) {
  EXPECT_NE(RefusalOfValue(std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_NE(RefusalOfValue(std::numeric_limits<double>::infinity()), "");
  EXPECT_NE(RefusalOfValue(-std::numeric_limits<double>::infinity()), "");
}

}  // namespace
}  // namespace loopgrid
