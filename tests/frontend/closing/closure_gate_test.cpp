#include "frontend/closing/closure_gate.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

using test_support::Walk;

// Nodes on a square of 10 m, a metre apart, twice round.
void AddSquare(Walk* walk, int nodes) {
  for (int i = 0; i < nodes; ++i) {
    const bool corner = i > 0 && i % 10 == 0;
    walk->Add(i == 0 ? SE2() : SE2(1.0, 0.0, corner ? 1.5707963 : 0.0), PointScan());
  }
}

// Whether some motion of the old node inside its gate brings it within view of the newest node.
// Tries motions on the border of the gate.
bool IsInsideByTrial(const SE2& T_old_newest, const Eigen::Matrix3d& covariance,
                     const ClosureGateOptions& options) {
  const Eigen::Vector2d p = T_old_newest.translation();
  Eigen::Matrix<double, 2, 3> J;
  J << -1.0, 0.0, p.y(), 0.0, -1.0, -p.x();
  const Eigen::Matrix2d L =
      Eigen::Matrix2d(J * covariance * J.transpose() + 1e-6 * Eigen::Matrix2d::Identity())
          .llt()
          .matrixL();
  const Eigen::Vector2d towards = -p.normalized() * std::max(p.norm() - options.view_distance, 0.0);
  return (L.inverse() * towards).norm() <= options.gate_sigmas;
}

TEST(ClosureGate, LetsInExactlyTheOldNodesWhoseCovarianceReachesTheNewest) {
  Walk walk;
  AddSquare(&walk, 70);
  const int newest = walk.nodes().size() - 1;
  ClosureGateOptions options;
  options.same_pass = 0;  // every node is a pass of its own
  options.max_candidates = 1000;
  int inside = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> sigma(0.05, 1.5);
    std::vector<Eigen::Matrix3d> covariances;
    for (int i = 0; i <= newest; ++i) {
      const double s = sigma(random);
      covariances.emplace_back(Eigen::Vector3d(s * s, 0.2 * s * s, 0.003 * s * s).asDiagonal());
    }
    std::vector<bool> found(static_cast<std::size_t>(newest) + 1, false);
    for (const ClosureCandidate& candidate :
         FindCandidates(walk.nodes(), 3, covariances, options)) {
      found[static_cast<std::size_t>(candidate.node)] = true;
      EXPECT_LE(candidate.distance_sigmas, options.gate_sigmas);
    }
    for (int j = 0; j <= newest; ++j) {
      const bool is_old = j >= 3 && j <= newest - options.recent_nodes;
      const bool expected =
          is_old && IsInsideByTrial(walk.nodes().Between(j, newest),
                                    covariances[static_cast<std::size_t>(j)], options);
      EXPECT_EQ(found[static_cast<std::size_t>(j)], expected) << j;
      inside += expected ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_LT(inside, 900);
}

TEST(ClosureGate, TakesTheLikeliestNodeOfEachPassAndTheLikeliestPassFirst) {
  // Three passes along one line, then the newest node where node 5 of each pass is.
  Walk walk;
  for (int pass = 0; pass < 4; ++pass) {
    for (int i = 0; i < 30; ++i) {
      walk.Add(i == 0 ? SE2(pass == 0 ? 0.0 : -29.0, 0.0, 0.0) : SE2(1.0, 0.0, 0.0), PointScan());
    }
    if (pass < 3) continue;
    walk.Add(SE2(-24.0, 0.0, 0.0), PointScan());
  }
  std::vector<Eigen::Matrix3d> covariances(static_cast<std::size_t>(walk.nodes().size()),
                                           Eigen::Vector3d(0.01, 0.01, 0.0001).asDiagonal());
  ClosureGateOptions options;
  options.max_candidates = 2;
  const auto candidates = FindCandidates(walk.nodes(), 0, covariances, options);
  ASSERT_EQ(candidates.size(), 2U);  // of four passes
  for (const ClosureCandidate& candidate : candidates) {
    EXPECT_EQ(candidate.node % 30, 5);
    EXPECT_NEAR(candidate.distance, 0.0, 1e-9);
  }
  EXPECT_LT(candidates[0].node, candidates[1].node);  // equally likely: the older first
}

TEST(ClosureGate, TheWindowGrowsWithTheCovariance) {
  Walk walk;
  AddSquare(&walk, 41);
  std::vector<Eigen::Matrix3d> covariances(41, Eigen::Matrix3d::Zero());
  covariances[0] = Eigen::Vector3d(4.0, 0.25, 0.01).asDiagonal();
  const ClosureGateOptions options;
  const auto candidates = FindCandidates(walk.nodes(), 0, covariances, options);
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates[0].node, 0);
  const SE2 T_old_newest = walk.nodes().Between(0, 40);
  // Position of the newest node seen from the old one: its rotation counts with the lever.
  const double x = std::sqrt(4.0 + 0.01 * T_old_newest.y() * T_old_newest.y() + 1e-6);
  const double y = std::sqrt(0.25 + 0.01 * T_old_newest.x() * T_old_newest.x() + 1e-6);
  EXPECT_NEAR(candidates[0].window.x, options.gate_sigmas * x + options.window_margin, 1e-9);
  EXPECT_NEAR(candidates[0].window.y, options.gate_sigmas * y + options.window_margin, 1e-9);
  EXPECT_NEAR(candidates[0].window.rotation,
              options.gate_sigmas * 0.1 + options.window_angle_margin, 1e-9);
}

}  // namespace
}  // namespace loopgrid
