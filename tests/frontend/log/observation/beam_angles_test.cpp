#include "frontend/log/observation/beam_angles.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <numbers>

namespace loopgrid {
namespace {

constexpr double kRadiansADegree = std::numbers::pi / 180.0;

TEST(UsualBeamAngles, FollowTheCountOfReadings) {
  const struct {
    std::size_t count;
    double first;  // degrees
    double step;
    double last;
  } expected[] = {
      {180, -90, 1, 89},
      {181, -90, 1, 90},
      {360, -90, 0.5, 89.5},
      {361, -90, 0.5, 90},
      {400, -50, 0.25, 49.75},
      {401, -50, 0.25, 50},
      {541, -135, 0.5, 135},
      {1081, -135, 0.25, 135},
      {1080, -135, 0.25, 134.75},
      {91, -90, 2, 90},
      {90, -90, 2, 88},
      {3, -90, 90, 90},
      {683, -119.8828125, 0.3515625, 119.8828125},
  };
  for (const auto& [count, first, step, last] : expected) {
    SCOPED_TRACE(count);
    const BeamAngles angles = UsualBeamAngles(count);
    EXPECT_NEAR(angles.first, first * kRadiansADegree, 1e-12);
    EXPECT_NEAR(angles.step, step * kRadiansADegree, 1e-12);
    EXPECT_NEAR(angles.first + angles.step * static_cast<double>(count - 1), last * kRadiansADegree,
                1e-9);
  }
}

TEST(UsualBeamAngles, OneReadingHasAStepToo) { EXPECT_GT(UsualBeamAngles(1).step, 0.0); }

}  // namespace
}  // namespace loopgrid
