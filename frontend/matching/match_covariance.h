#pragma once

#include <Eigen/Core>
#include <span>

#include "backend/geometry/se2.h"
#include "frontend/matching/likelihood_table.h"
#include "frontend/matching/match_refiner.h"
#include "frontend/matching/matching_options.h"

namespace loopgrid {

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
/// score alone would take the pattern of single hits on a bare wall for knowledge; the geometry
/// alone would take the errors of all hits for independent. Never singular: the options say which
/// standard deviations stand for "unknown".
Eigen::Matrix3d MatchCovariance(const LikelihoodTable& table,
                                std::span<const Eigen::Vector2f> points, const RefinedMatch& match,
                                const MatchCovarianceOptions& options = {});

}  // namespace loopgrid
