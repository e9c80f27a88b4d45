// Graphs whose information matrices differ by up to fourteen orders of magnitude: optimisers that
// say "converged" must be at the optimum, and covariances must be right.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "backend/graph/constraint_error.h"
#include "backend/solve/optimizer.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

using test_support::RandomPose;

template <typename Pose>
Constraint<Pose> ExactLink(const std::vector<Pose>& truth, int from, int to,
                           const typename Pose::Tangent& weights) {
  Constraint<Pose> link;
  link.from = from;
  link.to = to;
  link.T_from_to =
      truth[static_cast<std::size_t>(from)].Inverse() * truth[static_cast<std::size_t>(to)];
  link.information = weights.asDiagonal();
  return link;
}

/// A chain, with some closures or without, of exact measurements whose weights are anything from
/// 1e-2 to 1e12: F is 0 at the optimum. The start is `shift` away from it.
template <typename Pose>
PoseGraph<Pose> MixedChain(int nodes, int closures, double shift, unsigned seed,
                           std::vector<Pose>* truth) {
  using Tangent = typename Pose::Tangent;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(-2.0, 12.0);
  std::uniform_real_distribution<double> turn(-1.0, 1.0);
  const auto weights = [&] {
    Tangent result;
    const double all = std::pow(10.0, exponent(random));
    for (int i = 0; i < result.size(); ++i) {
      result(i) = seed % 2 == 0 ? all : std::pow(10.0, exponent(random));
    }
    return result;
  };
  *truth = {Pose()};
  PoseGraph<Pose> graph;
  for (int i = 1; i < nodes; ++i) {
    typename Pose::Point step = Pose::Point::Zero();
    step.x() = 1.0;
    truth->push_back(truth->back() *
                     test_support::PoseWithAngle<Pose>(step, turn(random), &random));
    graph.constraints.push_back(ExactLink(*truth, i - 1, i, weights()));
  }
  std::uniform_int_distribution<int> any(0, nodes - 3);
  for (int k = 0; k < closures; ++k) {
    const int from = any(random);
    const int to = std::uniform_int_distribution<int>(from + 2, nodes - 1)(random);
    graph.constraints.push_back(ExactLink(*truth, from, to, weights()));
  }
  graph.poses = *truth;
  for (int i = 1; i < nodes; ++i) {
    Tangent d;
    for (int k = 0; k < d.size(); ++k) d(k) = shift * turn(random);
    graph.poses[static_cast<std::size_t>(i)] = (*truth)[static_cast<std::size_t>(i)].Boxplus(d);
  }
  return graph;
}

struct Way {
  Method method;
  Parametrization parametrization;
};

const Way kWays[] = {
    {Method::kGaussNewton, Parametrization::kManifold},
    {Method::kGaussNewton, Parametrization::kEuler},
    {Method::kLevenbergMarquardt, Parametrization::kManifold},
    {Method::kLevenbergMarquardt, Parametrization::kEuler},
    {Method::kLevenbergMarquardt, Parametrization::kExponential},
    {Method::kDogLeg, Parametrization::kManifold},
};

template <typename Pose>
class MixedInformationTest : public ::testing::Test {
 protected:
  static OptimizerOptions Options(const Way& way) {
    OptimizerOptions options;
    options.method = way.method;
    options.parametrization = way.parametrization;
    return options;
  }
};

TYPED_TEST_SUITE(MixedInformationTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(MixedInformationTest, ConvergedMeansThatTheOptimumIsReached) {
  using Pose = TypeParam;
  for (const double shift : {1e-3, 0.1}) {
    for (const int closures : {0, 6}) {
      for (unsigned seed = 1; seed <= 6; ++seed) {
        std::vector<Pose> truth;
        const PoseGraph<Pose> start = MixedChain<Pose>(15, closures, shift, seed, &truth);
        for (const Way& way : kWays) {
          SCOPED_TRACE(::testing::Message()
                       << "seed " << seed << ", shift " << shift << ", " << closures
                       << " closures, method " << static_cast<int>(way.method)
                       << ", parametrization " << static_cast<int>(way.parametrization));
          PoseGraph<Pose> graph = start;
          const OptimizerResult result = Optimizer<Pose>(this->Options(way)).Optimize(&graph);
          EXPECT_TRUE(std::isfinite(result.final_error));
          if (result.termination == Termination::kConverged) {
            EXPECT_LE(result.final_error, 1e-6) << "after " << result.iterations;
          } else {
            // Where every direction has a weight of its own, valleys are too narrow for it.
            EXPECT_TRUE(way.method != Method::kLevenbergMarquardt || seed % 2 == 1)
                << ToString(result.termination) << " at " << result.final_error << " after "
                << result.iterations;
          }
        }
      }
    }
  }
}

// Not all measurements agree: a weak one pulls on a stiff chain.
TYPED_TEST(MixedInformationTest, AWeakClosureBendsAStiffChainAsFarAsItCan) {
  using Pose = TypeParam;
  using Tangent = typename Pose::Tangent;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937 random(seed);
    std::vector<Pose> truth = {Pose()};
    PoseGraph<Pose> start;
    for (int i = 1; i < 12; ++i) {
      truth.push_back(truth.back() * RandomPose<Pose>(&random, 1.0));
      // Free to turn about the third axis, or nearly so.
      Tangent weights = Tangent::Constant(1e10);
      weights(Pose::kDof - 1) = 1e-2;
      start.constraints.push_back(ExactLink(truth, i - 1, i, weights));
    }
    start.constraints.push_back(ExactLink(truth, 0, 11, Tangent::Constant(1e-2)));
    start.constraints.back().T_from_to =
        start.constraints.back().T_from_to.Boxplus(Tangent::Constant(0.2));
    start.poses = truth;
    double lowest = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, bool>> ends;
    for (const Way& way : kWays) {
      // Errors that are Euler angles have another minimum.
      if (Pose::kDof == 6 && way.parametrization == Parametrization::kEuler) continue;
      PoseGraph<Pose> graph = start;
      OptimizerOptions options = this->Options(way);
      options.relative_decrease = 1e-10;
      const OptimizerResult result = Optimizer<Pose>(options).Optimize(&graph);
      lowest = std::min(lowest, result.final_error);
      ends.emplace_back(result.final_error, result.termination == Termination::kConverged);
      if (way.method != Method::kDogLeg) {
        EXPECT_EQ(result.termination, Termination::kConverged)
            << "seed " << seed << ", method " << static_cast<int>(way.method)
            << ", parametrization " << static_cast<int>(way.parametrization) << ": "
            << ToString(result.termination) << " at " << result.final_error;
      }
    }
    for (const auto& [error, is_converged] : ends) {
      EXPECT_TRUE(!is_converged || error <= lowest * (1.0 + 1e-4) + 1e-8)
          << error << " instead of " << lowest << ", seed " << seed;
    }
  }
}

// A chain's covariances add up, seen from the last node.
TYPED_TEST(MixedInformationTest, CovariancesOfAChainAreTheSumsOfItsLinks) {
  using Pose = TypeParam;
  using Covariance = typename Marginals<Pose>::Covariance;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::vector<Pose> truth;
    const PoseGraph<Pose> graph = MixedChain<Pose>(20, 0, 0.0, seed, &truth);
    Optimizer<Pose> optimizer;
    const auto marginals = optimizer.ComputeMarginals(graph);
    ASSERT_TRUE(marginals.has_value()) << "seed " << seed;
    Covariance expected = Covariance::Zero();
    for (std::size_t i = 1; i < truth.size(); ++i) {
      const Covariance A = (truth[i].Inverse() * truth[i - 1]).Adjoint();
      const Covariance link = graph.constraints[i - 1].information.inverse();
      expected = A * expected * A.transpose() + link;
      const Covariance scale = expected.diagonal().cwiseSqrt().asDiagonal().inverse();
      const Covariance difference = marginals->covariances()[i] - expected;
      EXPECT_LE((scale * difference * scale).cwiseAbs().maxCoeff(), 1e-2)
          << "seed " << seed << ", node " << i;
    }
  }
}

/// A chain in whose middle a link says nothing about one direction.
template <typename Pose>
PoseGraph<Pose> ChainWithAFreeDirection(int direction, double weight, unsigned seed) {
  std::vector<Pose> truth;
  PoseGraph<Pose> graph = MixedChain<Pose>(20, 0, 0.0, seed, &truth);
  typename Pose::Tangent weights = Pose::Tangent::Constant(weight);
  weights(direction) = 0.0;
  graph.constraints[9].information = weights.asDiagonal();
  return graph;
}

TYPED_TEST(MixedInformationTest, ADirectionThatNothingHoldsHasNoCovariance) {
  using Pose = TypeParam;
  for (int direction = 0; direction < Pose::kDof; ++direction) {
    const PoseGraph<Pose> graph = ChainWithAFreeDirection<Pose>(direction, 1.0, 2);
    EXPECT_FALSE(Optimizer<Pose>().ComputeMarginals(graph).has_value()) << direction;
  }
}

// A damping that keeps steps short along the free direction is stronger than the weak link's other
// directions, which would need dozens of steps to their optimum.
TYPED_TEST(MixedInformationTest, ADirectionThatNothingHoldsDoesNotKeepTheOthersFromTheOptimum) {
  using Pose = TypeParam;
  for (const Method method : {Method::kLevenbergMarquardt, Method::kDogLeg}) {
    for (unsigned seed = 2; seed <= 8; seed += 2) {
      for (int direction = 0; direction < Pose::kDof; ++direction) {
        SCOPED_TRACE(::testing::Message() << "method " << static_cast<int>(method) << ", seed "
                                          << seed << ", direction " << direction);
        PoseGraph<Pose> graph = ChainWithAFreeDirection<Pose>(direction, 1e-2, seed);
        for (std::size_t i = 1; i < graph.poses.size(); ++i) {
          graph.poses[i] = graph.poses[i].Boxplus(Pose::Tangent::Constant(0.01));
        }
        const PoseGraph<Pose> start = graph;
        OptimizerOptions options;
        options.method = method;
        const OptimizerResult result = Optimizer<Pose>(options).Optimize(&graph);
        EXPECT_EQ(result.termination, Termination::kConverged) << ToString(result.termination);
        EXPECT_LE(result.final_error, 1e-8);
        EXPECT_LE(result.iterations, 15);
        for (std::size_t i = 0; i < graph.poses.size(); ++i) {
          EXPECT_LE(test_support::Distance(graph.poses[i], start.poses[i]), 1.0) << "node " << i;
        }
      }
    }
  }
}

}  // namespace
}  // namespace loopgrid
