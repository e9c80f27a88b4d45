#include "backend/solve/marginals.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/index.h"
#include "backend/solve/optimizer.h"
#include "tests/support/effort.h"
#include "tests/support/expect_marginals.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

using test_support::DenseHessian;
using test_support::InverseWithout;
using test_support::RandomGraph;
using test_support::StarGraph;

template <typename Pose>
class MarginalsTest : public ::testing::Test {
 protected:
  static constexpr int kDof = Pose::kDof;
  using Covariance = typename Marginals<Pose>::Covariance;

  /// Compares with the inverse of the dense Hessian without the rows and columns of one node: the
  /// definition of H_red in the tutorial.
  static void ExpectThoseOfTheReducedHessian(const PoseGraph<Pose>& graph, int node,
                                             double tolerance = 1e-9) {
    const auto covariances = RelativeCovariances(graph, node);
    ASSERT_TRUE(covariances.has_value());
    ASSERT_EQ(covariances->size(), graph.poses.size());
    const Eigen::MatrixXd expected = InverseWithout(DenseHessian(graph), {node}, kDof);
    for (int i = 0; i < static_cast<int>(graph.poses.size()); ++i) {
      const Covariance block = expected.block<kDof, kDof>(kDof * i, kDof * i);
      EXPECT_LE(((*covariances)[ToIndex(i)] - block).norm(), tolerance * block.norm())
          << "node " << i << " relative to " << node;
    }
  }
};

TYPED_TEST_SUITE(MarginalsTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(MarginalsTest, AreBlocksOfTheInverseWithoutTheHeldNodes) {
  for (const std::vector<int>& fixed : {std::vector<int>{}, {7}, {3, 15}}) {
    PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(25, 20, 68, 9);
    graph.fixed = fixed;
    Optimizer<TypeParam> optimizer;
    optimizer.Optimize(&graph);
    test_support::ExpectMarginalsOf(graph, optimizer.ComputeMarginals(graph));
  }
}

TYPED_TEST(MarginalsTest, AreThoseOfEachComponent) {
  const auto graph = test_support::Union(RandomGraph<TypeParam>(12, 8, 64, 3),
                                         RandomGraph<TypeParam>(10, 5, 65, 4));
  test_support::ExpectMarginalsOf(graph, Optimizer<TypeParam>().ComputeMarginals(graph));
}

TYPED_TEST(MarginalsTest, OfLandmarksThatNoNodeHasSeenAreZero) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(10, 5, 69, 2);
  graph.landmarks.emplace_back().setOnes();
  Optimizer<TypeParam> optimizer;
  optimizer.Optimize(&graph);
  const auto marginals = optimizer.ComputeMarginals(graph);
  ASSERT_TRUE(marginals);
  EXPECT_TRUE(marginals->landmark_covariances()[2].isZero(0.0));
  EXPECT_FALSE(marginals->landmark_covariances()[1].isZero(0.0));
  for (const auto& block : marginals->CrossCovariances(0)) {
    EXPECT_TRUE(block.isZero(0.0)) << "the first node is held";
  }
}

TYPED_TEST(MarginalsTest, RelativeToANodeAreThoseOfTheReducedHessian) {
  const auto graph = RandomGraph<TypeParam>(30, 15, 61, 6);
  for (int node : {0, 1, 17, 29}) this->ExpectThoseOfTheReducedHessian(graph, node);
}

TYPED_TEST(MarginalsTest, RelativeToANodeAreRightOnChainsAndStars) {
  const auto chain = RandomGraph<TypeParam>(25, 0, 62);
  this->ExpectThoseOfTheReducedHessian(chain, 24);
  this->ExpectThoseOfTheReducedHessian(chain, 10);
  const auto star = StarGraph<TypeParam>(20);
  this->ExpectThoseOfTheReducedHessian(star, 20);
  this->ExpectThoseOfTheReducedHessian(star, 7);
}

TYPED_TEST(MarginalsTest, RelativeToANodeDoNotDependOnWhichSingleNodeIsFixed) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(30, 10, 63, 4);
  const auto expected = RelativeCovariances(graph, 12);
  graph.fixed = {22};
  const auto covariances = RelativeCovariances(graph, 12);
  ASSERT_TRUE(expected && covariances);
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE((*covariances)[ToIndex(i)].isApprox((*expected)[ToIndex(i)], 1e-8)) << i;
  }
}

TYPED_TEST(MarginalsTest, RelativeToANodeRespectSeveralFixedNodes) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(20, 10, 70);
  graph.fixed = {3, 15};
  const auto relative = RelativeCovariances(graph, 3);
  ASSERT_TRUE(relative);
  EXPECT_TRUE((*relative)[15].isZero(1e-12));  // both are where they are
  constexpr int kDim = TypeParam::kDof;
  const Eigen::MatrixXd expected = InverseWithout(DenseHessian(graph), {3, 15}, kDim);
  const Eigen::MatrixXd block = expected.block<kDim, kDim>(10 * kDim, 10 * kDim);
  EXPECT_TRUE((*relative)[10].isApprox(block, 1e-9));
}

TYPED_TEST(MarginalsTest, AreInfiniteBetweenComponents) {
  const auto other = RandomGraph<TypeParam>(8, 4, 65, 2);
  const auto graph = test_support::Union(RandomGraph<TypeParam>(10, 5, 64, 2), other);
  const auto covariances = RelativeCovariances(graph, 13);
  const auto expected = RelativeCovariances(other, 3);
  ASSERT_TRUE(covariances && expected);
  for (int i = 0; i < 10; ++i) {
    const auto& block = (*covariances)[ToIndex(i)];
    for (int k = 0; k < TypeParam::kDof; ++k) EXPECT_TRUE(std::isinf(block(k, k)));
    EXPECT_EQ(block(0, 1), 0.0);
  }
  for (int i = 0; i < 8; ++i) {
    const auto difference = ((*covariances)[ToIndex(i + 10)] - (*expected)[ToIndex(i)]).eval();
    EXPECT_LE(difference.norm(), 1e-10 * (*expected)[ToIndex(i)].norm());
  }
}

TYPED_TEST(MarginalsTest, OfADanglingDirectionAreRefused) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(10, 0, 66);
  graph.constraints[4].information.setZero();
  graph.constraints[4].information(0, 0) = 1.0;  // a chain link that knows x alone
  EXPECT_FALSE(RelativeCovariances(graph, 9).has_value());
  EXPECT_FALSE(Optimizer<TypeParam>().ComputeMarginals(graph).has_value());
}

TYPED_TEST(MarginalsTest, AreRightWhenNearlySingular) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(20, 0, 67);
  graph.constraints[9].information *= 1e-6;  // two halves that hardly know each other
  // Ten of sixteen digits go to the condition of the matrix.
  this->ExpectThoseOfTheReducedHessian(graph, 19, 1e-5);
}

TYPED_TEST(MarginalsTest, OfLoneNodesAreTrivial) {
  PoseGraph<TypeParam> graph;
  graph.poses.resize(1);
  const auto covariances = RelativeCovariances(graph, 0);
  ASSERT_TRUE(covariances);
  EXPECT_TRUE((*covariances)[0].isZero(0.0));
}

TYPED_TEST(MarginalsTest, OfNodesThatAreNotThereAreErrors) {
  const auto graph = RandomGraph<TypeParam>(5, 0, 71, 2);
  Optimizer<TypeParam> optimizer;
  const auto marginals = optimizer.ComputeMarginals(graph);
  ASSERT_TRUE(marginals);
  for (int node : {-1, 5, 1 << 30}) {
    const auto expect_error = [node](const auto& ask) {
      try {
        ask();
        ADD_FAILURE() << "node " << node << " is accepted";
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput);
        EXPECT_EQ(error.what(),
                  "node " + std::to_string(node) + " is asked for, but the graph has 5 nodes");
      }
    };
    using Pairs = std::vector<std::pair<int, int>>;
    expect_error([&] { RelativeCovariances(graph, node); });
    expect_error([&] { marginals->RelativeTo(node); });
    expect_error([&] { marginals->CrossCovariances(node); });
    expect_error([&] { marginals->PairCovariances(Pairs{{1, 2}, {node, 2}}); });
    expect_error([&] { marginals->PairCovariances(Pairs{{1, 2}, {2, node}}); });
  }
}

TYPED_TEST(MarginalsTest, OfThePairThatIsAskedForTwiceAreGivenTwice) {
  const auto graph = RandomGraph<TypeParam>(9, 4, 72);
  Optimizer<TypeParam> optimizer;
  const auto marginals = optimizer.ComputeMarginals(graph);
  ASSERT_TRUE(marginals);
  const std::vector<std::pair<int, int>> pairs = {{3, 5}, {2, 5}, {3, 5}, {5, 3}, {3, 3}, {0, 3}};
  const auto blocks = marginals->PairCovariances(pairs);
  ASSERT_EQ(blocks.size(), pairs.size());
  EXPECT_EQ(blocks[0], blocks[2]);
  EXPECT_EQ(blocks[1], marginals->CrossCovariances(5)[2]);
  EXPECT_TRUE(blocks[3].isApprox(blocks[0].transpose(), 1e-12));
  EXPECT_TRUE(blocks[4].isApprox(marginals->covariances()[3], 1e-12));
  EXPECT_TRUE(blocks[5].isZero(0.0));
}

/// A chain of steps of a metre, each 1 cm and `angle` radians uncertain, that bends to and fro; the
/// poses are where the steps lead.
template <typename Pose>
PoseGraph<Pose> LongChain(int nodes, double angle) {
  PoseGraph<Pose> graph;
  graph.poses.emplace_back();
  typename Pose::Tangent deviations = Pose::Tangent::Constant(0.01);
  deviations.template tail<Pose::kDof - Pose::Point::RowsAtCompileTime>().setConstant(angle);
  const typename Pose::Tangent weights = deviations.array().square().inverse();
  for (int i = 1; i < nodes; ++i) {
    typename Pose::Tangent step = Pose::Tangent::Zero();
    step[0] = 1.0;
    step[Pose::kDof - 1] = 0.02 * std::sin(0.01 * i);
    Constraint<Pose> link;
    link.from = i - 1;
    link.to = i;
    link.T_from_to = Pose().Boxplus(step);
    link.information = weights.asDiagonal();
    graph.poses.push_back(graph.poses.back() * link.T_from_to);
    graph.constraints.push_back(link);
  }
  return graph;
}

TYPED_TEST(MarginalsTest, RelativeToTheEndOfALongChainAreSumsOverItsSteps) {
  using Pose = TypeParam;
  using Block = typename TestFixture::Covariance;
  // Variances relative to the first node are 1e13 times those from one node to the next, so that a
  // difference of them would not keep a digit. With the last node held, double precision would
  // still be wrong by a hundredth.
  constexpr int kNodes =
      Pose::kDof == 3 ? test_support::Effort(100'000, 5'000) : test_support::Effort(20'000, 1'000);
  const auto graph = LongChain<Pose>(kNodes, 0.002);
  OptimizerOptions options;
  options.careful_covariances = false;  // those with the first node held do not matter
  Optimizer<Pose> optimizer(options);
  const auto marginals = optimizer.ComputeMarginals(graph);
  ASSERT_TRUE(marginals);
  const std::vector<Block> relative = marginals->RelativeTo(kNodes - 1).nodes;
  Block expected = Block::Zero();
  for (int i = kNodes - 2; i >= 0; --i) {
    // Each step's error moves all nodes before it alike, seen from the last.
    const Constraint<Pose>& link = graph.constraints[ToIndex(i)];
    const Block A = link.T_from_to.Adjoint();
    expected = (A * (expected + link.information.inverse()) * A.transpose()).eval();
    const Block& found = relative[ToIndex(i)];
    for (int k = 0; k < Pose::kDof; ++k) {
      ASSERT_NEAR(found(k, k), expected(k, k), 1e-6 * expected(k, k)) << "node " << i;
    }
  }
}

TYPED_TEST(MarginalsTest, RelativeToANodeAreThoseWithItHeldWhereDigitsWouldBeLost) {
  // A chain with closures, landmarks and a robust loss, more than 1e8 times more uncertain at its
  // end than from one node to the next.
  auto graph = LongChain<TypeParam>(3000, 0.02);
  RobustLoss loss;
  loss.kind = LossKind::kHuber;
  for (int i = 0; i + 10 < 3000; i += 100) {
    Constraint<TypeParam> closure = graph.constraints[0];
    closure.from = i;
    closure.to = i + 10;
    closure.robust = true;
    const auto T = graph.poses[ToIndex(i)].Inverse() * graph.poses[ToIndex(i + 10)];
    closure.T_from_to = T.Boxplus(TypeParam::Tangent::Constant(0.001 * (i % 7) * (i % 3)));
    graph.constraints.push_back(closure);
    LandmarkObservation<TypeParam> observation;
    observation.node = i;
    observation.landmark = i / 100;
    observation.p_node.setConstant(2.0);
    observation.information *= 1e4;
    graph.landmarks.push_back(graph.poses[ToIndex(i)] * observation.p_node);
    graph.observations.push_back(observation);
  }
  const int node = 2995;
  PoseGraph<TypeParam> held = graph;
  held.fixed = {node};
  OptimizerOptions options;
  options.loss = loss;
  Optimizer<TypeParam> optimizer(options);
  Optimizer<TypeParam> other(options);
  const auto marginals = optimizer.ComputeMarginals(graph);
  const auto expected = other.ComputeMarginals(held);
  ASSERT_TRUE(marginals && expected);
  // They are computed like those that they are compared with, so that only the order of sums is
  // another; as differences of covariances they would agree to a thousandth.
  const auto relative = marginals->RelativeTo(node);
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    const auto& block = expected->covariances()[i];
    ASSERT_LE((relative.nodes[i] - block).norm(), 1e-9 * block.norm()) << "node " << i;
  }
  for (std::size_t i = 0; i < graph.landmarks.size(); ++i) {
    const auto& block = expected->landmark_covariances()[i];
    ASSERT_LE((relative.landmarks[i] - block).norm(), 1e-9 * block.norm()) << "landmark " << i;
  }
}

TYPED_TEST(MarginalsTest, CarriedAlongAChainAreThoseOfANewFactorisation) {
  for (unsigned seed = 71; seed < 75; ++seed) {
    SCOPED_TRACE(seed);
    // A graph with closures, then a tail of single links, each met exactly by its new node.
    PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(25, seed % 2 == 0 ? 12 : 0, seed);
    const auto tail = RandomGraph<TypeParam>(12, 0, seed + 100);
    auto covariances = RelativeCovariances(graph, 24);
    ASSERT_TRUE(covariances);
    for (Constraint<TypeParam> link : tail.constraints) {
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
    EXPECT_NEAR((*covariances)[ToIndex(i)](0, 0), (10 - i) / 4.0, 1e-6);
    EXPECT_NEAR((*covariances)[ToIndex(i)](1, 1), (10 - i) / 25.0, 1e-6);
  }
  EXPECT_TRUE(covariances->back().isZero(0.0));
}

}  // namespace
}  // namespace loopgrid
