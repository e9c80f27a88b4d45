#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace loopgrid {

/// Drops each point that is closer than `spacing` metres to the last one kept, so that a near wall
/// with many points has no more weight than a far one. Keeps the order.
std::vector<Eigen::Vector2f> ThinPoints(std::span<const Eigen::Vector2f> points, float spacing);

/// At most `count` of the points, evenly spread over their order.
std::vector<Eigen::Vector2f> LimitPoints(std::span<const Eigen::Vector2f> points,
                                         std::size_t count);

/// The angular step by which most of `points` move at most `resolution` metres when they turn
/// around the origin; radians, between 0.004 and 0.02.
double AngleStepFor(std::span<const Eigen::Vector2f> points, double resolution);

}  // namespace loopgrid
