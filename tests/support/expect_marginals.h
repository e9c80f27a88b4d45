#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "backend/solve/marginals.h"
#include "tests/support/graphs.h"

namespace loopgrid::test_support {

/// Compares all covariances, and those of some pairs of nodes, with the dense inverse of the
/// Hessian at the graph's poses without the held nodes.
template <typename Pose>
void ExpectMarginalsOf(const PoseGraph<Pose>& graph,
                       const std::optional<Marginals<Pose>>& marginals, const RobustLoss& loss = {},
                       double tolerance = 1e-9) {
  constexpr int kDof = Pose::kDof;
  constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  using Covariance = typename Marginals<Pose>::Covariance;
  using PointCovariance = typename Marginals<Pose>::PointCovariance;
  ASSERT_TRUE(marginals.has_value());
  const int nodes = static_cast<int>(graph.poses.size());
  const int landmarks = static_cast<int>(graph.landmarks.size());
  ASSERT_EQ(static_cast<int>(marginals->covariances().size()), nodes);
  ASSERT_EQ(static_cast<int>(marginals->landmark_covariances().size()), landmarks);
  const Eigen::MatrixXd inverse = InverseWithout(
      DenseNormalEquations(graph, {loss}).H, HeldNodes(graph, ConnectedComponents(graph)), kDof);
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < nodes; ++i) {
    const Covariance expected = inverse.block<kDof, kDof>(kDof * i, kDof * i);
    const Covariance& found = marginals->covariances()[static_cast<std::size_t>(i)];
    EXPECT_LE((found - expected).norm(), tolerance * expected.norm()) << "node " << i;
    pairs.emplace_back(i, (7 * i) % nodes);
    pairs.emplace_back(i, nodes - 1);
  }
  for (int i = 0; i < landmarks; ++i) {
    const int row = kDof * nodes + kPoint * i;
    const PointCovariance expected = inverse.block<kPoint, kPoint>(row, row);
    const PointCovariance& found = marginals->landmark_covariances()[static_cast<std::size_t>(i)];
    EXPECT_LE((found - expected).norm(), tolerance * expected.norm()) << "landmark " << i;
  }
  const std::vector<Covariance> of_pairs = marginals->PairCovariances(pairs);
  ASSERT_EQ(of_pairs.size(), pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const Covariance expected = inverse.block<kDof, kDof>(kDof * i, kDof * j);
    // The covariance of distant nodes is small, so the tolerance is relative to their own
    // covariances.
    const double scale = std::sqrt(inverse.block<kDof, kDof>(kDof * i, kDof * i).norm() *
                                   inverse.block<kDof, kDof>(kDof * j, kDof * j).norm());
    EXPECT_LE((of_pairs[k] - expected).norm(), tolerance * scale) << i << " with " << j;
  }
}

}  // namespace loopgrid::test_support
