#pragma once

#include <Eigen/Core>
#include <span>

#include "backend/geometry/se2.h"
#include "frontend/matching/likelihood_table.h"
#include "frontend/matching/match_refiner.h"
#include "frontend/matching/matching_options.h"

namespace loopgrid {

/// Information of a match, from the shape of its score. It is the inverse of Olson's covariance K/s
/// - u u^T/s^2 (ICRA 2009, section on covariance estimation) with p = exp(score) summed over a
/// lattice around `T_map_robot`. The lattice lies along the principal axes of `shape`, an estimate
/// of the score's curvature (robot frame), so it is long along corridors and fine across them. The
/// finite size of the lattice adds no information: where the score is flat in a direction, the
/// information is zero. Robot frame, order (x, y, theta), positive semi-definite.
Eigen::Matrix3d ScoreInformation(const LikelihoodTable& table,
                                 std::span<const Eigen::Vector2f> points, const SE2& T_map_robot,
                                 const Eigen::Matrix3d& shape,
                                 const MatchCovarianceOptions& options = {});

/// Covariance of a refined match, robot frame, order (x, y, theta): the width of the score (from
/// ScoreInformation) plus the uncertainty of the geometry (the inverse of `match.information`). The
/// score alone would be too certain along a bare wall, because it also matches the pattern of
/// single hits. The geometry alone would be too certain, because it treats the errors of all hits
/// as independent. The covariance is never singular: the options have the standard deviations for
/// "unknown".
Eigen::Matrix3d MatchCovariance(const LikelihoodTable& table,
                                std::span<const Eigen::Vector2f> points, const RefinedMatch& match,
                                const MatchCovarianceOptions& options = {});

}  // namespace loopgrid
