#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "backend/solve/optimizer.h"

namespace loopgrid {

/// The state after every step of an optimisation as CSV text: a header, then one line for the start
/// and one for each step: iteration,F,chi2,damping,step,seconds (see IterationRecord).
std::string FormatTraceCsv(const std::vector<IterationRecord>& trace);

/// (iteration, F) of every line of such a file. The columns are found by their names; other columns
/// may be missing. F may be inf or nan. Throws Error (kInput) `file:line: ...`.
std::vector<Eigen::Vector2d> ReadTraceCsv(const std::string& path);

}  // namespace loopgrid
