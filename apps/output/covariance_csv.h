#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "backend/files/graph_file.h"
#include "backend/solve/marginals.h"

namespace loopgrid {

/// Covariances of nodes and landmarks as CSV text: a header that names the columns with their
/// units, then one line for each: its id and the upper triangle, row by row. Columns that a
/// landmark does not have are empty.
template <typename Pose>
std::string FormatCovarianceCsv(
    const GraphIds& ids, const std::vector<typename Marginals<Pose>::Covariance>& of_nodes,
    const std::vector<typename Marginals<Pose>::PointCovariance>& of_landmarks);

}  // namespace loopgrid
