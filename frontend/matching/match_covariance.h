#pragma once

#include <Eigen/Core>
#include <span>

#include "backend/geometry/se2.h"
#include "frontend/matching/likelihood_table.h"
#include "frontend/matching/match_refiner.h"

namespace loopgrid {

struct MatchCovarianceOptions {
  /// Log-likelihood of a perfect hit over that of a miss. Below 1 because neighbouring beams err
  /// together: calibrated so that chi-square of closed loops comes out near its expectation.
  double hit_log_likelihood = 4.0;
  /// Standard deviation the lattice is laid for at least, metres ... (finer, it lies within one or
  /// two cells of the table, where the score is flat and looks as if nothing were known.)
  double narrowest = 0.02;
  double widest = 0.4;  ///< ... and at most: beyond, the match knows nothing
};

/// What a match knows, from the shape of its score: the inverse of Olson's covariance
/// K/s - u u^T/s^2 (ICRA 2009, Section on covariance estimation) with p = exp(score) summed over a
/// lattice around `T_map_robot`. The lattice lies along the principal axes of `shape`, an estimate
/// of the score's curvature (robot frame), so that it reaches along corridors and stays fine across
/// them. The lattice's own finite extent adds no knowledge: directions in which the score is flat
/// come out with zero information. Robot frame, order (x, y, theta), positive semi-definite.
Eigen::Matrix3d ScoreInformation(const LikelihoodTable& table,
                                 std::span<const Eigen::Vector2f> points, const SE2& T_map_robot,
                                 const Eigen::Matrix3d& shape,
                                 const MatchCovarianceOptions& options = {});

/// Covariance of a refined match, robot frame, order (x, y, theta): the width of the score (from
/// ScoreInformation) plus what the geometry leaves open (the inverse of `match.information`). The
/// score alone would believe in the pattern of single hits on a bare wall; the geometry alone in
/// hits without any error in common. Never singular: 20 m and 3 rad stand for "unknown".
Eigen::Matrix3d MatchCovariance(const LikelihoodTable& table,
                                std::span<const Eigen::Vector2f> points, const RefinedMatch& match,
                                const MatchCovarianceOptions& options = {});

}  // namespace loopgrid
