#include "frontend/matching/match_refiner.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::BareCorridor;
using test_support::DistinctiveRoom;
using test_support::ExactLaser;
using test_support::MapFrom;
using test_support::PortableRandom;
using test_support::ScanFrom;
using test_support::SimulatedLaser;

constexpr double kRefinerDegree = std::numbers::pi / 180.0;

const std::array<SE2, 3> kRefinerMapPoses = {SE2(), SE2(1.5, 2.0, 1.0), SE2(-2.5, -1.5, 2.0)};

PosePrior NoPrior(const SE2& pose) { return {pose, Eigen::Matrix3d::Zero()}; }

TEST(RefineMatch, RecoversADisplacedPoseToAMillimetre) {
  const LocalMap map = MapFrom(DistinctiveRoom(), kRefinerMapPoses);
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    const SE2 truth{random.Uniform(-2.0, 1.0), random.Uniform(-2.0, 0.5), random.Uniform(-3, 3)};
    const double way = random.Uniform(-3.0, 3.0);
    const SE2 start = truth.Boxplus(
        {0.1 * std::cos(way), 0.1 * std::sin(way), random.Uniform(-3.0, 3.0) * kRefinerDegree});
    const PointScan scan = ScanFrom(DistinctiveRoom(), truth);
    const RefinedMatch match = RefineMatch(map, scan, start, NoPrior(start));
    const Eigen::Vector3d error = match.T_map_robot.Boxminus(truth);
    EXPECT_LT(error.head<2>().norm(), 1e-3);
    EXPECT_LT(std::abs(error.z()), 0.02 * kRefinerDegree);
    EXPECT_GT(match.inlier_share, 0.97);
    EXPECT_LT(match.residual, 5e-3);
    EXPECT_GT(match.used, 600);
  }
}

// The cost that the refiner minimises, with the surfaces that are nearest at `solution`.
double Cost(const LocalMap& map, const PointScan& scan, const SE2& solution, const SE2& pose,
            const PosePrior& prior, const RefinerOptions& options) {
  double cost = 0.0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.normals[i].isZero()) continue;
    const Eigen::Vector2d hit = scan.hits[i].cast<double>();
    const Eigen::Vector2d n = solution.rotation() * scan.normals[i].cast<double>();
    const Surfel* surfel = map.NearestSurface((solution * hit).cast<float>(), n.cast<float>());
    if (surfel == nullptr) continue;
    const double r =
        surfel->normal.cast<double>().dot(pose * hit - surfel->position.cast<double>());
    const double ratio = r / options.last_scale;
    const double sigmas = r / options.range_sigma;
    cost += 0.5 * sigmas * sigmas / (1.0 + ratio * ratio);  // Geman-McClure
  }
  const Eigen::Vector3d e = pose.Boxminus(prior.T_map_robot);
  return cost + 0.5 * e.dot(prior.information * e);
}

TEST(RefineMatch, EndsWhereTheNumericGradientOfTheCostVanishes) {
  const LocalMap map = MapFrom(DistinctiveRoom(), kRefinerMapPoses, SimulatedLaser{});
  RefinerOptions options;
  options.max_iterations = 100;
  options.normal_sigma = 0.0;  // so that the normal equations are those of the cost
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    const SE2 truth{random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 0.5), random.Uniform(-3, 3)};
    const PointScan scan = ScanFrom(DistinctiveRoom(), truth, SimulatedLaser{}, seed);
    PosePrior prior = NoPrior(truth.Boxplus({0.06, -0.08, 0.05}));
    if (seed % 2 == 0) prior.information = Eigen::Vector3d(2e5, 1e3, 1e2).asDiagonal();
    const RefinedMatch match = RefineMatch(map, scan, prior.T_map_robot, prior, options);
    Eigen::Vector3d gradient;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = 1e-5 * Eigen::Vector3d::Unit(k);
      const SE2& at = match.T_map_robot;
      gradient(k) = (Cost(map, scan, at, at.Boxplus(d), prior, options) -
                     Cost(map, scan, at, at.Boxplus(-d), prior, options)) /
                    2e-5;
    }
    const Eigen::Matrix3d H = match.information + prior.information;
    const Eigen::Vector3d away = H.ldlt().solve(gradient);  // the distance to the minimum
    EXPECT_LT(away.head<2>().norm(), 6e-4);
    EXPECT_LT(std::abs(away.z()), 4e-4);
  }
}

TEST(RefineMatch, InformationIsTheSumOverNumericJacobians) {
  const LocalMap map = MapFrom(DistinctiveRoom(), kRefinerMapPoses);
  const SE2 truth(0.4, -0.3, 0.7);
  const PointScan scan = ScanFrom(DistinctiveRoom(), truth, ExactLaser(360));
  RefinerOptions options;
  options.normal_sigma = 0.0;
  const RefinedMatch match = RefineMatch(map, scan, truth, NoPrior(truth), options);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.normals[i].isZero()) continue;
    const auto place = [&](const Eigen::Vector3d& d) -> Eigen::Vector2d {
      return match.T_map_robot.Boxplus(d) * scan.hits[i].cast<double>();
    };
    const Eigen::Vector2d p = place(Eigen::Vector3d::Zero());
    const Eigen::Vector2d n = match.T_map_robot.rotation() * scan.normals[i].cast<double>();
    const Surfel* surfel = map.NearestSurface(p.cast<float>(), n.cast<float>());
    if (surfel == nullptr) continue;
    const Eigen::Vector2d across = surfel->normal.cast<double>();
    Eigen::Vector3d J;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = 1e-5 * Eigen::Vector3d::Unit(k);
      J(k) = across.dot(place(d) - place(-d)) / 2e-5;
    }
    const double ratio = across.dot(p - surfel->position.cast<double>()) / options.last_scale;
    const double root = 1.0 / (1.0 + ratio * ratio);
    expected += root * root * J * J.transpose() / (options.range_sigma * options.range_sigma);
  }
  EXPECT_LT((match.information - expected).norm(), 1e-4 * expected.norm());
}

TEST(RefineMatch, KnowsNothingAlongABareCorridorAndLeavesThatToThePrior) {
  const SE2 along(1.0, 0.2, 0.1);
  const LocalMap map = MapFrom(BareCorridor(), std::array<SE2, 1>{along});
  const SE2 truth(0.5, -0.1, 0.3);
  const PointScan scan = ScanFrom(BareCorridor(), truth);
  for (double shift : {-0.1, 0.0, 0.07}) {
    for (double turn : {-0.04, 0.0, 0.05}) {
      SCOPED_TRACE(shift);
      PosePrior prior;
      prior.T_map_robot = SE2(0.5 + shift, -0.05, 0.3 + turn);
      prior.information = Eigen::Vector3d(100.0, 100.0, 100.0).asDiagonal();
      const RefinedMatch match = RefineMatch(map, scan, truth, prior);
      EXPECT_NEAR(match.T_map_robot.y(), truth.y(), 2e-3);
      EXPECT_NEAR(match.T_map_robot.theta(), truth.theta(), 1e-3);
      EXPECT_NEAR(match.T_map_robot.x(), prior.T_map_robot.x(), 2e-4);
      const Eigen::Vector3d forth =
          match.T_map_robot.Adjoint().inverse() * Eigen::Vector3d::UnitX();
      const Eigen::Vector3d across =
          match.T_map_robot.Adjoint().inverse() * Eigen::Vector3d::UnitY();
      EXPECT_LT(forth.dot(match.information * forth),
                1e-6 * across.dot(match.information * across));
    }
  }
}

TEST(RefineMatch, WithoutSurfacesStaysOrGoesToThePrior) {
  const PointScan scan = ScanFrom(DistinctiveRoom(), SE2());
  const SE2 start(3.0, -2.0, 1.0);
  const LocalMap far = MapFrom(DistinctiveRoom(), std::array<SE2, 1>{SE2()});
  for (const LocalMap& map : {LocalMap(), far}) {
    const SE2 away = SE2(500.0, 0.0, 0.0) * start;
    const RefinedMatch match = RefineMatch(map, scan, away, NoPrior(away));
    EXPECT_NEAR(match.T_map_robot.Boxminus(away).norm(), 0.0, 1e-12);
    EXPECT_EQ(match.used, 0);
    EXPECT_EQ(match.inlier_share, 0.0);
    EXPECT_EQ(match.residual, 0.0);
    EXPECT_TRUE(match.information.isZero(0.0));
    const PosePrior prior{away.Boxplus({0.5, 0.2, -0.4}), 1e3 * Eigen::Matrix3d::Identity()};
    const RefinedMatch guided = RefineMatch(map, scan, away, prior);
    EXPECT_LT(guided.T_map_robot.Boxminus(prior.T_map_robot).norm(), 1e-3);
  }
}

TEST(RefineMatch, YieldsNumbersFromAwkwardScans) {
  const LocalMap map = MapFrom(DistinctiveRoom(), kRefinerMapPoses);
  PointScan at_the_laser;  // hits without any lever
  for (int i = 0; i < 30; ++i) {
    at_the_laser.hits.emplace_back(0.0F, 0.0F);
    at_the_laser.normals.emplace_back(1.0F, 0.0F);
  }
  PointScan no_normals = ScanFrom(DistinctiveRoom(), SE2());
  for (Eigen::Vector2f& normal : no_normals.normals) normal.setZero();
  PointScan one = ScanFrom(DistinctiveRoom(), SE2());
  one.hits.resize(1);
  one.normals.resize(1);
  for (const PointScan& scan : {PointScan(), at_the_laser, no_normals, one}) {
    for (const SE2& start : {SE2(), SE2(-3.99, 0.0, 0.0), SE2(4.9, -2.9, 3.0)}) {
      const RefinedMatch match = RefineMatch(map, scan, start, NoPrior(start));
      EXPECT_TRUE(match.T_map_robot.coordinates().allFinite());
      EXPECT_TRUE(match.information.allFinite());
      EXPECT_TRUE(std::isfinite(match.inlier_share) && std::isfinite(match.residual));
      EXPECT_LT(match.T_map_robot.Boxminus(start).norm(), 1.0);
    }
  }
}

TEST(RefineMatch, IsNotPulledAwayByWhatIsNotInTheMap) {
  const LocalMap map = MapFrom(DistinctiveRoom(), kRefinerMapPoses);
  test_support::World with_people = DistinctiveRoom();
  with_people.AddBox({1.0, 0.9}, {0.3, 0.3});
  with_people.AddBox({-1.0, -1.2}, {0.4, 0.3});
  const SE2 truth(0.2, 0.1, 0.5);
  const SE2 start = truth.Boxplus({0.05, -0.05, 0.03});
  const RefinedMatch match = RefineMatch(map, ScanFrom(with_people, truth), start, NoPrior(start));
  EXPECT_LT(match.T_map_robot.Boxminus(truth).norm(), 1e-3);
  EXPECT_LT(match.inlier_share, 0.95);
}

}  // namespace
}  // namespace loopgrid
