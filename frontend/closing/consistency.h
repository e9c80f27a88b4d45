#pragma once

#include <Eigen/Core>
#include <vector>

namespace loopgrid {

/// The hypotheses that agree with each other.
struct ConsistentSet {
  std::vector<int> members;  ///< indices, ascending
  double separation = 0.0;   ///< first over second eigenvalue: how clearly there is one set
};

/// Single-cluster partition after Olson, "Recognizing places using spectrally clustered local
/// matches" (RAS 2009): the indicator vector that maximises the mean agreement inside the set,
/// found by thresholding the dominant eigenvector of `agreement` (symmetric, entries 0..1).
ConsistentSet FindConsistentSet(const Eigen::MatrixXd& agreement);

}  // namespace loopgrid
