#include "frontend/matching/local_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace loopgrid {
namespace {

Eigen::Vector2f Direction(float angle) { return {std::cos(angle), std::sin(angle)}; }

// Hits in a square of the given half width, half of them with a normal.
PointScan RandomScan(int count, float reach, std::mt19937* random) {
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  PointScan scan;
  for (int i = 0; i < count; ++i) {
    scan.hits.emplace_back(reach * uniform(*random), reach * uniform(*random));
    const Eigen::Vector2f normal = Direction(std::numbers::pi_v<float> * uniform(*random));
    scan.normals.push_back(i % 4 == 0 ? Eigen::Vector2f::Zero() : normal);
  }
  return scan;
}

LocalMap MapOf(const PointScan& scan, double radius = 100.0) {
  const std::array<PlacedScan, 1> placed = {{{&scan, SE2()}}};
  return LocalMap(placed, Eigen::Vector2d::Zero(), radius);
}

PointScan ScanOf(std::vector<Eigen::Vector2f> hits, const Eigen::Vector2f& normal) {
  PointScan scan;
  scan.normals.assign(hits.size(), normal);
  scan.hits = std::move(hits);
  return scan;
}

const Surfel* NearestByTryingAll(const LocalMap& map, const Eigen::Vector2f& point,
                                 const Eigen::Vector2f& normal) {
  const Surfel* best = nullptr;
  float best_distance = LocalMap::kBucket * LocalMap::kBucket;
  for (const Surfel& s : map.surfels()) {
    const float distance = (s.position - point).squaredNorm();
    if (distance >= best_distance || s.normal.dot(normal) <= 0.7F) continue;
    best = &s;
    best_distance = distance;
  }
  return best;
}

TEST(LocalMap, FindsTheNearestSurfaceThatTryingAllFinds) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const LocalMap map = MapOf(RandomScan(400, seed % 2 == 0 ? 1.0F : 4.0F, &random));
    std::uniform_real_distribution<float> coordinate(-4.5F, 4.5F);
    int found = 0;
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector2f point(coordinate(random), coordinate(random));
      const Eigen::Vector2f normal = Direction(coordinate(random));
      const Surfel* surfel = map.NearestSurface(point, normal);
      ASSERT_EQ(surfel, NearestByTryingAll(map, point, normal)) << point.transpose();
      found += surfel != nullptr ? 1 : 0;
    }
    EXPECT_GT(found, 50);
  }
}

TEST(LocalMap, TakesTheLowerIndexOfTwoEquallyNear) {
  const LocalMap map = MapOf(ScanOf({{0.125F, 0.0F}, {-0.125F, 0.0F}}, {0.0F, 1.0F}));
  ASSERT_EQ(map.surfels().size(), 2U);
  EXPECT_EQ(map.NearestSurface({0.0F, 0.0F}, {0.0F, 1.0F}), map.surfels().data());
}

TEST(LocalMap, WithoutSurfacesFindsNone) {
  const LocalMap none;
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.NearestSurface({0.0F, 0.0F}, {1.0F, 0.0F}), nullptr);
  EXPECT_EQ(none.NearestSurface({-900.0F, 900.0F}, {1.0F, 0.0F}), nullptr);
  const LocalMap of_nothing({}, Eigen::Vector2d::Zero(), 10.0);
  EXPECT_TRUE(of_nothing.empty());
  const LocalMap of_empty_scan = MapOf(PointScan{});
  EXPECT_EQ(of_empty_scan.NearestSurface({0.0F, 0.0F}, {1.0F, 0.0F}), nullptr);
}

TEST(LocalMap, FindsNoneFarOutside) {
  const LocalMap map = MapOf(ScanOf({{0.0F, 0.0F}}, {0.0F, 1.0F}));
  for (float far : {0.3F, 1.0F, 1e4F}) {
    EXPECT_EQ(map.NearestSurface({far, 0.0F}, {0.0F, 1.0F}), nullptr);
    EXPECT_EQ(map.NearestSurface({-far, 0.0F}, {0.0F, 1.0F}), nullptr);
    EXPECT_EQ(map.NearestSurface({0.0F, far}, {0.0F, 1.0F}), nullptr);
    EXPECT_EQ(map.NearestSurface({0.0F, -far}, {0.0F, 1.0F}), nullptr);
  }
}

TEST(LocalMap, KeepsTheFacesOfAThinWallApart) {
  PointScan scan = ScanOf({{0.01F, 0.01F}, {0.02F, 0.03F}}, {0.0F, 1.0F});
  scan.normals[1] = {0.0F, -1.0F};
  const LocalMap map = MapOf(scan);  // both in one square
  ASSERT_EQ(map.surfels().size(), 2U);
  const Surfel* upper = map.NearestSurface({0.0F, 0.1F}, {0.0F, 1.0F});
  const Surfel* lower = map.NearestSurface({0.0F, 0.1F}, {0.0F, -1.0F});
  ASSERT_TRUE(upper != nullptr && lower != nullptr);
  EXPECT_EQ(upper->position, scan.hits[0]);
  EXPECT_EQ(lower->position, scan.hits[1]);
}

TEST(LocalMap, MergesTheHitsOfASquareIntoTheirMean) {
  const float s = LocalMap::kSquare;
  PointScan scan =
      ScanOf({{0.1F * s, 0.1F * s}, {0.9F * s, 0.5F * s}, {1.1F * s, 0.5F * s}}, Direction(1.5F));
  scan.normals[1] = Direction(1.6F);
  const LocalMap map = MapOf(scan);
  ASSERT_EQ(map.surfels().size(), 2U);
  const Surfel& merged = map.surfels()[0].weight > 1.5F ? map.surfels()[0] : map.surfels()[1];
  EXPECT_EQ(merged.weight, 2.0F);
  EXPECT_NEAR((merged.position - Eigen::Vector2f(0.5F * s, 0.3F * s)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((merged.normal - Direction(1.55F)).norm(), 0.0, 1e-6);
}

TEST(LocalMap, CountsEveryHitOnceInASquareOfItsOwn) {
  std::mt19937 random(31);
  const LocalMap map = MapOf(RandomScan(3000, 0.5F, &random));
  float weight = 0.0F;
  for (const Surfel& s : map.surfels()) {
    weight += s.weight;
    const float length = s.normal.norm();
    EXPECT_TRUE(length == 0.0F || std::abs(length - 1.0F) < 1e-5F) << length;
  }
  EXPECT_EQ(weight, 3000.0F);
  EXPECT_LE(map.surfels().size(), 21U * 21U * 5U);
}

TEST(LocalMap, LeavesOutHitsBeyondTheRadius) {
  const PointScan scan = ScanOf({{1.9F, 0.0F}, {2.1F, 0.0F}, {0.0F, 2.1F}}, {1.0F, 0.0F});
  const LocalMap map = MapOf(scan, 2.0);
  ASSERT_EQ(map.surfels().size(), 1U);
  EXPECT_EQ(map.surfels()[0].position, scan.hits[0]);
  EXPECT_EQ(map.lower(), map.upper());
  EXPECT_TRUE(MapOf(scan, 1.0).empty());
}

TEST(LocalMap, PutsScansWhereTheyWereTaken) {
  const PointScan scan = ScanOf({{1.0F, 0.0F}}, {-1.0F, 0.0F});
  const SE2 quarter(5.0, 3.0, 0.5 * std::numbers::pi);
  const std::array<PlacedScan, 2> placed = {{{&scan, SE2(-2.0, 0.0, 0.0)}, {&scan, quarter}}};
  const LocalMap map(placed, Eigen::Vector2d(1.0, 1.0), 50.0);
  EXPECT_NE(map.NearestSurface({-1.0F, 0.0F}, {-1.0F, 0.0F}), nullptr);
  EXPECT_NE(map.NearestSurface({5.0F, 4.0F}, {0.0F, -1.0F}), nullptr);
  EXPECT_EQ(map.NearestSurface({5.0F, 4.0F}, {0.0F, 1.0F}), nullptr);
  EXPECT_NEAR((map.lower() - Eigen::Vector2f(-1.0F, 0.0F)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((map.upper() - Eigen::Vector2f(5.0F, 4.0F)).norm(), 0.0, 1e-6);
}

TEST(LocalMap, HoldsTheSameSurfelsInWhateverOrderScansCome) {
  std::mt19937 random(41);
  const PointScan a = RandomScan(300, 1.0F, &random);
  const PointScan b = RandomScan(300, 1.0F, &random);
  const SE2 pose(0.3, -0.2, 0.4);
  const std::array<PlacedScan, 2> forth = {{{&a, SE2()}, {&b, pose}}};
  const std::array<PlacedScan, 2> back = {{{&b, pose}, {&a, SE2()}}};
  const LocalMap one(forth, Eigen::Vector2d::Zero(), 10.0);
  const LocalMap other(back, Eigen::Vector2d::Zero(), 10.0);
  ASSERT_EQ(one.surfels().size(), other.surfels().size());
  for (const Surfel& s : one.surfels()) {
    const bool there =
        std::any_of(other.surfels().begin(), other.surfels().end(), [&](const Surfel& t) {
          return (s.position - t.position).norm() < 1e-5F && (s.normal - t.normal).norm() < 1e-4F &&
                 s.weight == t.weight;
        });
    EXPECT_TRUE(there) << s.position.transpose();
  }
}

}  // namespace
}  // namespace loopgrid
