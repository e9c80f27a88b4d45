#include "frontend/closing/consistency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>

namespace loopgrid {

ConsistentSet FindConsistentSet(const Eigen::MatrixXd& agreement) {
  ConsistentSet set;
  const int n = static_cast<int>(agreement.rows());
  if (n == 0) return set;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(agreement);
  Eigen::VectorXd dominant = solver.eigenvectors().col(n - 1);
  if (dominant.sum() < 0.0) dominant = -dominant;
  const double second = n > 1 ? std::max(solver.eigenvalues()(n - 2), 0.0) : 0.0;
  set.separation =
      second > 0.0 ? solver.eigenvalues()(n - 1) / second : std::numeric_limits<double>::infinity();

  // Try every threshold: add members in descending order of the eigenvector's entries.
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return dominant(a) > dominant(b); });
  double inside = 0.0;
  double best = -1.0;
  int best_count = 0;
  for (int count = 1; count <= n; ++count) {
    const int added = order[static_cast<std::size_t>(count - 1)];
    inside += agreement(added, added);
    for (int k = 0; k + 1 < count; ++k)
      inside += 2.0 * agreement(added, order[static_cast<std::size_t>(k)]);
    const double mean = inside / count;
    if (mean > best) {
      best = mean;
      best_count = count;
    }
  }
  set.members.assign(order.begin(), order.begin() + best_count);
  std::sort(set.members.begin(), set.members.end());
  return set;
}

}  // namespace loopgrid
