#include "backend/marginals.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>

#include "backend/base/error.h"
#include "backend/optimizer.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

/// Compares with the inverse of the dense Hessian without the rows and columns of one node: the
/// definition of H_red in the tutorial.
void ExpectRelativeCovariancesAreThoseOfTheReducedHessian(const PoseGraph<SE2>& graph, int node,
                                                          double tolerance = 1e-9) {
  const auto covariances = RelativeCovariances(graph, node);
  ASSERT_TRUE(covariances.has_value());
  ASSERT_EQ(covariances->size(), graph.poses.size());
  const Eigen::MatrixXd expected =
      test_support::InverseWithout(test_support::DenseHessian(graph), {node}, 3);
  for (int i = 0; i < static_cast<int>(graph.poses.size()); ++i) {
    const Eigen::Matrix3d block = expected.block<3, 3>(3 * i, 3 * i);
    EXPECT_LE(((*covariances)[Index(i)] - block).norm(), tolerance * block.norm())
        << "node " << i << " relative to " << node;
  }
}

TEST(RelativeCovariances, AreTheBlocksOfTheInverseOfTheReducedHessian) {
  const PoseGraph<SE2> graph = test_support::RandomGraph(60, 30, 61);
  for (int node : {0, 1, 17, 59}) {
    ExpectRelativeCovariancesAreThoseOfTheReducedHessian(graph, node);
  }
}

TEST(RelativeCovariances, AreRightOnChainsAndStars) {
  ExpectRelativeCovariancesAreThoseOfTheReducedHessian(test_support::RandomGraph(50, 0, 62), 49);
  ExpectRelativeCovariancesAreThoseOfTheReducedHessian(test_support::RandomGraph(50, 0, 62), 20);
  ExpectRelativeCovariancesAreThoseOfTheReducedHessian(test_support::StarGraph(40), 40);
  ExpectRelativeCovariancesAreThoseOfTheReducedHessian(test_support::StarGraph(40), 7);
}

TEST(RelativeCovariances, DoNotDependOnWhichSingleNodeIsFixed) {
  PoseGraph<SE2> graph = test_support::RandomGraph(30, 10, 63);
  const auto expected = RelativeCovariances(graph, 12);
  graph.fixed = {22};
  const auto covariances = RelativeCovariances(graph, 12);
  ASSERT_TRUE(expected && covariances);
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE((*covariances)[Index(i)].isApprox((*expected)[Index(i)], 1e-8)) << i;
  }
}

TEST(RelativeCovariances, GrowAlongAChainByTheCovarianceOfEachStep) {
  // Straight steps without rotation uncertainty to speak of: variances of steps add up.
  PoseGraph<SE2> graph;
  Eigen::Matrix3d information = Eigen::Vector3d(4.0, 25.0, 1e12).asDiagonal();
  graph.poses.emplace_back();
  for (int i = 1; i <= 10; ++i) {
    graph.poses.emplace_back(1.0 * i, 0.0, 0.0);
    graph.constraints.push_back({i - 1, i, SE2(1.0, 0.0, 0.0), information});
  }
  const auto covariances = RelativeCovariances(graph, 10);
  ASSERT_TRUE(covariances);
  for (int i = 0; i <= 10; ++i) {
    EXPECT_NEAR((*covariances)[Index(i)](0, 0), (10 - i) / 4.0, 1e-6);
    EXPECT_NEAR((*covariances)[Index(i)](1, 1), (10 - i) / 25.0, 1e-6);
  }
  EXPECT_TRUE(covariances->back().isZero(0.0));
}

TEST(RelativeCovariances, AreInfiniteBetweenComponents) {
  PoseGraph<SE2> graph = test_support::RandomGraph(10, 5, 64);
  const PoseGraph<SE2> other = test_support::RandomGraph(8, 4, 65);
  for (Constraint<SE2> constraint : other.constraints) {
    constraint.from += 10;
    constraint.to += 10;
    graph.constraints.push_back(constraint);
  }
  graph.poses.insert(graph.poses.end(), other.poses.begin(), other.poses.end());
  const auto covariances = RelativeCovariances(graph, 13);
  const auto expected = RelativeCovariances(other, 3);
  ASSERT_TRUE(covariances && expected);
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(std::isinf((*covariances)[Index(i)](0, 0)) &&
                std::isinf((*covariances)[Index(i)](2, 2)));
    EXPECT_EQ((*covariances)[Index(i)](0, 1), 0.0);
  }
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE((*covariances)[Index(i + 10)].isApprox((*expected)[Index(i)], 1e-10) || i == 3);
  }
}

TEST(RelativeCovariances, OfADanglingDirectionAreRefused) {
  PoseGraph<SE2> graph = test_support::RandomGraph(10, 0, 66);
  graph.constraints[4].information.setZero();
  graph.constraints[4].information(0, 0) = 1.0;  // a chain link that knows x alone
  EXPECT_FALSE(RelativeCovariances(graph, 9).has_value());
}

TEST(RelativeCovariances, AreRightWhenNearlySingular) {
  PoseGraph<SE2> graph = test_support::RandomGraph(20, 0, 67);
  graph.constraints[9].information *= 1e-7;  // two halves that hardly know each other
  // Seven of sixteen digits go to the condition of the matrix, in the reference too.
  ExpectRelativeCovariancesAreThoseOfTheReducedHessian(graph, 19, 1e-6);
}

TEST(RelativeCovariances, OfLoneNodesAreTrivial) {
  PoseGraph<SE2> graph;
  graph.poses.resize(1);
  const auto covariances = RelativeCovariances(graph, 0);
  ASSERT_TRUE(covariances);
  EXPECT_TRUE((*covariances)[0].isZero(0.0));
}

TEST(RelativeCovariances, OfNodesThatAreNotThereAreErrors) {
  const PoseGraph<SE2> graph = test_support::RandomGraph(5, 0, 71);
  EXPECT_THROW(RelativeCovariances(graph, 5), Error);
  EXPECT_THROW(RelativeCovariances(graph, -1), Error);
}

TEST(Marginals, WithTheFirstNodeHeldAreBlocksOfTheInverse) {
  PoseGraph<SE2> graph = test_support::RandomGraph(40, 30, 68);
  Optimizer<SE2> optimizer;
  optimizer.Optimize(&graph);
  const auto marginals = optimizer.ComputeMarginals(graph);
  ASSERT_TRUE(marginals);
  const Eigen::MatrixXd expected =
      test_support::InverseWithout(test_support::DenseHessian(graph), {0}, 3);
  const auto cross = marginals->CrossCovariances(23);
  EXPECT_TRUE(marginals->covariances()[0].isZero(0.0));
  for (int i = 1; i < 40; ++i) {
    const Eigen::Matrix3d block = expected.block<3, 3>(3 * i, 3 * i);
    const Eigen::Matrix3d cross_block = expected.block<3, 3>(3 * i, 3 * 23);
    EXPECT_TRUE(marginals->covariances()[Index(i)].isApprox(block, 1e-9)) << i;
    EXPECT_TRUE(cross[Index(i)].isApprox(cross_block, 1e-9)) << i;
  }
}

TEST(Marginals, CrossCovariancesWithAHeldNodeAreZero) {
  PoseGraph<SE2> graph = test_support::RandomGraph(10, 5, 69);
  Optimizer<SE2> optimizer;
  optimizer.Optimize(&graph);
  for (const Eigen::Matrix3d& block : optimizer.ComputeMarginals(graph)->CrossCovariances(0)) {
    EXPECT_TRUE(block.isZero(0.0));
  }
}

TEST(Marginals, RespectSeveralFixedNodes) {
  PoseGraph<SE2> graph = test_support::RandomGraph(20, 10, 70);
  graph.fixed = {3, 15};
  const auto relative = RelativeCovariances(graph, 3);
  ASSERT_TRUE(relative);
  EXPECT_TRUE((*relative)[15].isZero(1e-12));  // both are where they are
  const Eigen::MatrixXd expected =
      test_support::InverseWithout(test_support::DenseHessian(graph), {3, 15}, 3);
  const Eigen::Matrix3d block = expected.block<3, 3>(30, 30);
  EXPECT_TRUE((*relative)[10].isApprox(block, 1e-9));
}

/// A loop of nodes, each of which sees three of four landmarks; a fifth is seen by nobody.
template <typename Pose>
PoseGraph<Pose> GraphWithLandmarks() {
  std::mt19937 random(81);
  std::normal_distribution<double> normal;
  const auto noise = [&](auto vector, double sigma) -> decltype(vector) {
    for (double& number : vector) number = sigma * normal(random);
    return vector;
  };
  PoseGraph<Pose> graph;
  for (int i = 0; i < 6; ++i) {
    graph.poses.push_back(Pose(noise(typename Pose::Tangent(), 0.4)));
    graph.constraints.emplace_back();
    graph.constraints.back().from = i == 0 ? 5 : i - 1;
    graph.constraints.back().to = i;
  }
  for (auto& constraint : graph.constraints) {
    constraint.T_from_to =
        (graph.poses[Index(constraint.from)].Inverse() * graph.poses[Index(constraint.to)])
            .Boxplus(noise(typename Pose::Tangent(), 0.01));
    constraint.information = 100.0 * Constraint<Pose>::Information::Identity();
  }
  for (int k = 0; k < 5; ++k) graph.landmarks.push_back(noise(typename Pose::Point(), 3.0));
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) {
      LandmarkObservation<Pose> observation;
      observation.node = i;
      observation.landmark = (i + k) % 4;
      observation.p_node =
          graph.poses[Index(i)].Inverse() * graph.landmarks[Index(observation.landmark)];
      observation.information *= 50.0 + 10.0 * k;
      graph.observations.push_back(observation);
    }
  }
  return graph;
}

template <typename Pose>
void ExpectLandmarksRelativeToANodeAreThoseWithItHeld() {
  PoseGraph<Pose> graph = GraphWithLandmarks<Pose>();
  Optimizer<Pose> optimizer;
  ASSERT_EQ(optimizer.Optimize(&graph).termination, Termination::kConverged);
  const auto marginals = optimizer.ComputeMarginals(graph);
  ASSERT_TRUE(marginals);
  for (int node = 0; node < 6; ++node) {
    PoseGraph<Pose> held = graph;
    held.fixed = {node};
    Optimizer<Pose> other;
    const auto expected = other.ComputeMarginals(held);
    ASSERT_TRUE(expected);
    const auto relative = marginals->LandmarksRelativeTo(node);
    ASSERT_EQ(relative.size(), 5u);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_TRUE(relative[k].isApprox(expected->landmark_covariances()[k], 1e-9))
          << k << " relative to " << node;
    }
    EXPECT_TRUE(std::isinf(relative[4](0, 0)));
    EXPECT_EQ(relative[4](0, 1), 0.0);
  }
}

TEST(Marginals, OfLandmarksRelativeToANodeAreThoseWithItHeld) {
  ExpectLandmarksRelativeToANodeAreThoseWithItHeld<SE2>();
  ExpectLandmarksRelativeToANodeAreThoseWithItHeld<SE3>();
}

TEST(ExtendRelativeCovariances, GivesWhatANewFactorisationWould) {
  for (unsigned seed = 71; seed < 77; ++seed) {
    SCOPED_TRACE(seed);
    // A graph with closures, then a tail of single links, each met exactly by its new node.
    PoseGraph<SE2> graph = test_support::RandomGraph(25, seed % 2 == 0 ? 12 : 0, seed);
    const PoseGraph<SE2> tail = test_support::RandomGraph(12, 0, seed + 100);
    auto covariances = RelativeCovariances(graph, 24);
    ASSERT_TRUE(covariances);
    for (Constraint<SE2> link : tail.constraints) {
      link.from += 24;
      link.to += 24;
      graph.poses.push_back(graph.poses.back() * link.T_from_to);
      graph.constraints.push_back(link);
      ExtendRelativeCovariances(graph, link, &*covariances);
      const auto expected = RelativeCovariances(graph, link.to);
      ASSERT_TRUE(expected);
      ASSERT_EQ(covariances->size(), graph.poses.size());
      for (std::size_t i = 0; i < expected->size(); ++i) {
        EXPECT_LE(((*covariances)[i] - (*expected)[i]).norm(), 1e-9 * (*expected)[i].norm())
            << i << " relative to " << link.to;
      }
    }
    EXPECT_TRUE(covariances->back().isZero(0.0));
  }
}

}  // namespace
}  // namespace loopgrid
