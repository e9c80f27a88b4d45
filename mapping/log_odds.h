#pragma once

namespace loopgrid {

/// What a scan adds to the log-odds ln(p / (1 - p)) of a cell that it touches, where p is the
/// probability that the cell is occupied (Moravec and Elfes 1985). A beam that ends in a cell says
/// more about it than one that passes: a beam may pass a cell that is occupied only in part.
inline constexpr double kHitLogOdds = 0.85;   ///< where a beam ends: p = 0.7
inline constexpr double kMissLogOdds = -0.4;  ///< where beams only pass: p = 0.4

/// The log-odds of a cell do not become larger than this, nor smaller than its negative.
inline constexpr double kMaxLogOdds = 100.0;

}  // namespace loopgrid
