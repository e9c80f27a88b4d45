#include "frontend/slam/slam_options.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "backend/base/error.h"
#include "frontend/slam/slam.h"

namespace loopgrid {
namespace {

// The message of the error for these options; empty if they are valid.
std::string RefusalOf(const SlamOptions& options) {
  try {
    const Slam slam(options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    return error.what();
  }
  return {};
}

// Sets the field that `field` returns a pointer to.
template <typename Field, typename Value>
SlamOptions WithOption(Field field, Value value) {
  SlamOptions options;
  *field(&options) = value;
  return options;
}

TEST(SlamOptions, TheDefaultsAreGood) { EXPECT_EQ(RefusalOf({}), ""); }

TEST(SlamOptions, NamesTheFieldThatIsOutOfRangeWithItsValueAndBounds) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto distance = [](SlamOptions* o) { return &o->node_distance; };
  for (double value : {0.0, -1.0, 0.049, 10.01, 1e300, nan}) {
    EXPECT_EQ(RefusalOf(WithOption(distance, value)).find("node_distance is "), 0U) << value;
  }
  EXPECT_EQ(RefusalOf(WithOption(distance, 10.01)), "node_distance is 10.01, expected 0.05 to 10");
  const auto angle = [](SlamOptions* o) { return &o->node_angle; };
  for (double value : {0.0, -0.5, 0.049, 3.01, nan}) {
    EXPECT_EQ(RefusalOf(WithOption(angle, value)).find("node_angle is "), 0U) << value;
  }
  const auto threads = [](SlamOptions* o) { return &o->threads; };
  for (int value : {0, -1, 1025}) {
    EXPECT_EQ(RefusalOf(WithOption(threads, value)).find("threads is "), 0U) << value;
  }
  for (double value : {0.05, 3.0}) {
    SlamOptions options;
    options.node_distance = options.node_angle = value;
    EXPECT_EQ(RefusalOf(options), "");
  }
}

TEST(SlamOptions, LooksIntoTheOptionsOfEveryComponent) {
  const double bad = -1.0;
  const auto refused = [&](auto field) { return RefusalOf(WithOption(field, bad)); };
  using O = SlamOptions;
  EXPECT_NE(refused([](O* o) { return &o->no_return.max_range; }), "");
  EXPECT_NE(refused([](O* o) { return &o->no_return.normals.max_gap; }), "");
  EXPECT_NE(refused([](O* o) { return &o->tracker.min_score; }), "");
  EXPECT_NE(refused([](O* o) { return &o->tracker.odometry.translation_floor; }), "");
  EXPECT_NE(refused([](O* o) { return &o->tracker.refiner.range_sigma; }), "");
  EXPECT_NE(refused([](O* o) { return &o->tracker.covariance.widest; }), "");
  EXPECT_NE(refused([](O* o) { return &o->known_space.distance; }), "");
  EXPECT_NE(refused([](O* o) { return &o->standstill.distance; }), "");
  EXPECT_NE(refused([](O* o) { return &o->carried.distance; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.finder.max_sigma; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.finder.gate.gate_sigmas; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.finder.matcher.min_score; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.finder.matcher.visibility.farthest; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.finder.place_finder.spacing; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.verifier.min_separation; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.graph.max_chi2; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.graph.loss.width; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.linker.max_shift; }), "");
  EXPECT_NE(refused([](O* o) { return &o->closing.linker.window.rotation; }), "");
}

}  // namespace
}  // namespace loopgrid
