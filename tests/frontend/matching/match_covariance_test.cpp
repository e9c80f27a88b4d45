#include "frontend/matching/match_covariance.h"

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
using test_support::World;

using Points = std::vector<Eigen::Vector2f>;

LikelihoodTable TableOf(const Points& reference, float resolution, float sigma) {
  Eigen::Vector2f lower = reference.front();
  Eigen::Vector2f upper = reference.front();
  for (const Eigen::Vector2f& p : reference) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const int margin = static_cast<int>(4.0F * sigma / resolution) + 20;
  return {reference, lower, upper, margin, resolution, sigma, 1};
}

// A scan matched at its true pose, and the inputs of its covariance.
struct Matched {
  LocalMap map;
  LikelihoodTable table;
  PointScan scan;
  RefinedMatch match;

  Eigen::Matrix3d Covariance() const { return MatchCovariance(table, scan.hits, match); }
};

LikelihoodTable TableOf(const LocalMap& map) {
  Points surfaces;
  for (const Surfel& s : map.surfels()) surfaces.push_back(s.position);
  return TableOf(surfaces, 0.05F, 0.07F);
}

Matched MatchIn(const World& world, const SE2& truth, const SimulatedLaser& laser,
                double radius = 30.0) {
  LocalMap map = MapFrom(world, std::array<SE2, 1>{truth.Boxplus({0.2, 0.1, 0.1})}, laser, radius);
  PointScan scan = ScanFrom(world, truth, laser, 3);
  const RefinedMatch match = RefineMatch(map, scan, truth, {truth, Eigen::Matrix3d::Zero()});
  LikelihoodTable table = TableOf(map);
  return {std::move(map), std::move(table), std::move(scan), match};
}

Eigen::Vector3d Eigenvalues(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvalues();
}

Eigen::Matrix3d Shape(const Matched& m) { return 10.0 * m.match.information; }

TEST(ScoreInformation, IsSymmetricAndPositiveSemiDefinite) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    const SE2 truth{random.Uniform(-2.0, 1.0), random.Uniform(-2.0, 0.5), random.Uniform(-3, 3)};
    const World world = seed % 3 == 0 ? BareCorridor(8.0) : DistinctiveRoom();
    const Matched m = MatchIn(world, truth, SimulatedLaser{});
    Eigen::Matrix3d odd = Eigen::Matrix3d::Zero();  // every shape is allowed
    odd.diagonal() << random.Uniform(0.0, 1e6), random.Uniform(0.0, 1.0), random.Uniform(0, 1e3);
    for (const Eigen::Matrix3d& shape : {Shape(m), odd, Eigen::Matrix3d(Eigen::Matrix3d::Zero())}) {
      const Eigen::Matrix3d information = ScoreInformation(m.table, m.scan.hits, truth, shape);
      ASSERT_TRUE(information.allFinite());
      EXPECT_EQ(information, information.transpose());
      EXPECT_GE(Eigenvalues(information)(0), -1e-9 * information.norm());
    }
  }
}

// The definition: moments of exp(score) over a lattice that is fine and wide enough for the whole
// peak.
Eigen::Matrix3d InformationBySumming(const LikelihoodTable& table, const Points& points,
                                     const Eigen::Vector3d& sigmas, double hit_log_likelihood) {
  constexpr int kHalf = 12;
  constexpr double kSpacing = 0.35;  // sigmas
  double s = 0.0;
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  for (int a = -kHalf; a <= kHalf; ++a) {
    for (int b = -kHalf; b <= kHalf; ++b) {
      for (int c = -kHalf; c <= kHalf; ++c) {
        const Eigen::Vector3d d = kSpacing * sigmas.cwiseProduct(Eigen::Vector3d(a, b, c));
        const SE2 pose(d);
        double score = 0.0;
        for (const Eigen::Vector2f& p : points) {
          const Eigen::Vector2d q = pose * p.cast<double>();
          score += table.At(table.CellOf(q.cast<float>())) / 255.0;
        }
        const double weight =
            std::exp(hit_log_likelihood * (score - static_cast<double>(points.size())));
        s += weight;
        u += weight * d;
        K += weight * d * d.transpose();
      }
    }
  }
  return (K / s - u * u.transpose() / (s * s)).inverse();
}

TEST(ScoreInformation, IsCloseToThatOfAFineLatticeOnASmoothScore) {
  // Points far apart, each its own reference: the score is nearly a Gaussian.
  for (double lever : {1.5, 4.0}) {
    SCOPED_TRACE(lever);
    Points points;
    for (int i = 0; i < 12; ++i) {
      const double angle = 0.2 + std::numbers::pi * i / 6.0;
      points.emplace_back(static_cast<float>(lever * std::cos(angle)),
                          static_cast<float>(lever * std::sin(angle)));
    }
    constexpr double kSigma = 0.2;
    const LikelihoodTable table = TableOf(points, 0.01F, static_cast<float>(kSigma));
    MatchCovarianceOptions options;
    options.hit_log_likelihood = 2.0;
    const double per_metre = options.hit_log_likelihood * 12.0 / (kSigma * kSigma);
    const Eigen::Vector3d shape(per_metre, per_metre, per_metre * lever * lever);
    const Eigen::Matrix3d expected = InformationBySumming(
        table, points, shape.cwiseSqrt().cwiseInverse(), options.hit_log_likelihood);
    const Eigen::Matrix3d information =
        ScoreInformation(table, points, SE2(), shape.asDiagonal(), options);
    const Eigen::Vector3d ratio = information.diagonal().cwiseQuotient(expected.diagonal());
    // Its few points reach 2.7 sigmas, so it has less information than the definition, but more
    // than half.
    EXPECT_GT(ratio.minCoeff(), 0.5) << ratio.transpose();
    EXPECT_LT(ratio.maxCoeff(), 1.0) << ratio.transpose();
  }
}

TEST(ScoreInformation, OfAFlatScoreIsNothing) {
  const Points none;
  Points everywhere;
  for (int x = -100; x <= 100; ++x) {
    for (int y = -100; y <= 100; ++y) {
      everywhere.emplace_back(0.05F * static_cast<float>(x), 0.05F * static_cast<float>(y));
    }
  }
  const LikelihoodTable full = TableOf(everywhere, 0.1F, 0.1F);
  const Points points = {{1.0F, 0.0F}, {-1.0F, 0.5F}, {0.0F, -1.0F}};
  const Eigen::Matrix3d shape = Eigen::Vector3d(400.0, 400.0, 400.0).asDiagonal();
  EXPECT_LT(ScoreInformation(full, points, SE2(), shape).norm(), 1e-6);
  EXPECT_LT(ScoreInformation(full, points, SE2(500.0, 0.0, 0.0), shape).norm(), 1e-6);
  EXPECT_TRUE(ScoreInformation(full, none, SE2(), shape).isZero(0.0));
}

TEST(MatchCovariance, IsPositiveDefiniteAndSmallInADistinctiveRoom) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    const SE2 truth{random.Uniform(-2.0, 1.0), random.Uniform(-2.0, 0.5), random.Uniform(-3, 3)};
    SimulatedLaser all_around = ExactLaser(360);
    all_around.range_noise = 0.01;
    const Eigen::Matrix3d covariance = MatchIn(DistinctiveRoom(), truth, all_around).Covariance();
    EXPECT_EQ(covariance, covariance.transpose());
    EXPECT_GT(Eigenvalues(covariance)(0), 0.0);
    EXPECT_LT(std::sqrt(Eigenvalues(covariance)(2)), 0.03);  // a good match has a small covariance
  }
}

TEST(MatchCovariance, TurnsWithTheRobotsFrame) {
  // The same scan in the same room, in the frame of a robot that is turned and shifted.
  const SE2 truth(0.3, -0.4, 0.2);
  const Matched m = MatchIn(DistinctiveRoom(), truth, ExactLaser(360));
  const Eigen::Matrix3d covariance = m.Covariance();
  for (const SE2& T_robot_other : {SE2(0, 0, 1.0), SE2(0, 0, -2.5), SE2(0.4, -0.3, 0.7)}) {
    SCOPED_TRACE(T_robot_other.coordinates().transpose());
    const SE2 pose = truth * T_robot_other;
    SimulatedLaser laser = ExactLaser(360);
    laser.T_robot_laser = T_robot_other.Inverse();
    const PointScan scan = ScanFrom(DistinctiveRoom(), pose, laser, 3);
    const RefinedMatch match = RefineMatch(m.map, scan, pose, {pose, Eigen::Matrix3d::Zero()});
    const Eigen::Matrix3d other = MatchCovariance(m.table, scan.hits, match);
    const Eigen::Matrix3d A = T_robot_other.Adjoint();
    // The lattice falls on other cells, and from another place it has other axes.
    const double tolerance = T_robot_other.translation().isZero() ? 1.25 : 2.0;
    const Eigen::Matrix3d back = A * other * A.transpose();
    const Eigen::Vector3d ratio = back.diagonal().cwiseQuotient(covariance.diagonal());
    EXPECT_GT(ratio.minCoeff(), 1.0 / tolerance) << ratio.transpose();
    EXPECT_LT(ratio.maxCoeff(), tolerance) << ratio.transpose();
  }
}

TEST(MatchCovariance, TellsAlongFromAcrossInACorridor) {
  for (double heading : {0.0, 0.5, 1.5707, -2.0}) {
    SCOPED_TRACE(heading);
    const SE2 truth(0.0, 0.1, heading);
    const Matched m = MatchIn(BareCorridor(), truth, SimulatedLaser{}, 15.0);
    const Eigen::Matrix2d in_map =
        truth.rotation() * m.Covariance().topLeftCorner<2, 2>() * truth.rotation().transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(in_map);
    EXPECT_GT(std::sqrt(axes.eigenvalues()(1)), 1.0);
    EXPECT_LT(std::sqrt(axes.eigenvalues()(0)), 0.05);
    EXPECT_GT(std::abs(axes.eigenvectors()(0, 1)), std::cos(0.05));  // the long one is along x
  }
}

TEST(MatchCovariance, GrowsWithFewerHitsAndNoisierOnes) {
  const SE2 truth(0.3, -0.4, 0.2);
  double last = 0.0;
  for (int beams : {720, 180, 60, 30}) {
    const double trace = MatchIn(DistinctiveRoom(), truth, ExactLaser(beams)).Covariance().trace();
    EXPECT_GT(trace, last) << beams;
    last = trace;
  }
  last = 0.0;
  for (double noise : {0.0, 0.04, 0.1}) {
    SimulatedLaser laser = ExactLaser(360);
    laser.range_noise = noise;
    const LocalMap map = MapFrom(DistinctiveRoom(), std::array<SE2, 1>{truth}, ExactLaser());
    const PointScan scan = ScanFrom(DistinctiveRoom(), truth, laser, 5);
    const RefinedMatch match = RefineMatch(map, scan, truth, {truth, Eigen::Matrix3d::Zero()});
    const double trace = MatchCovariance(TableOf(map), scan.hits, match).trace();
    EXPECT_GT(trace, last) << noise;
    last = trace;
  }
}

TEST(MatchCovariance, OfAMatchThatKnowsNothingIsTwentyMetresAndThreeRadiansTwice) {
  const LikelihoodTable table = TableOf({{0.0F, 0.0F}}, 0.05F, 0.07F);
  RefinedMatch nothing;
  nothing.range_sigma = 0.03;
  const Eigen::Matrix3d covariance = MatchCovariance(table, {}, nothing);
  EXPECT_NEAR(covariance(0, 0), 800.0, 1e-6);
  EXPECT_NEAR(covariance(1, 1), 800.0, 1e-6);
  EXPECT_NEAR(covariance(2, 2), 18.0, 1e-6);
}

}  // namespace
}  // namespace loopgrid
