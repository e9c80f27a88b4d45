#include "backend/guess/initial_guess.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "backend/base/error.h"
#include "backend/graph/constraint_error.h"
#include "tests/support/noisy_graphs.h"
#include "tests/support/poses.h"

namespace loopgrid {
namespace {

template <typename Pose>
class InitialGuessTest : public ::testing::Test {
 protected:
  static constexpr int kSize = Pose::Point::RowsAtCompileTime;

  static void ExpectSame(const PoseGraph<Pose>& a, const PoseGraph<Pose>& b, double tolerance) {
    for (std::size_t i = 0; i < b.poses.size(); ++i) {
      EXPECT_LE(test_support::Distance(a.poses[i], b.poses[i]), tolerance) << "node " << i;
    }
    for (std::size_t i = 0; i < b.landmarks.size(); ++i) {
      EXPECT_LE((a.landmarks[i] - b.landmarks[i]).norm(), tolerance) << "landmark " << i;
    }
  }
};
TYPED_TEST_SUITE(InitialGuessTest, test_support::AllPoses, test_support::PoseName);

/// Two graphs side by side that nothing joins.
template <typename Pose>
PoseGraph<Pose> Joined(PoseGraph<Pose> graph, const PoseGraph<Pose>& other) {
  const auto nodes = static_cast<int>(graph.poses.size());
  const auto landmarks = static_cast<int>(graph.landmarks.size());
  graph.poses.insert(graph.poses.end(), other.poses.begin(), other.poses.end());
  graph.landmarks.insert(graph.landmarks.end(), other.landmarks.begin(), other.landmarks.end());
  for (Constraint<Pose> constraint : other.constraints) {
    constraint.from += nodes;
    constraint.to += nodes;
    graph.constraints.push_back(constraint);
  }
  for (LandmarkObservation<Pose> observation : other.observations) {
    observation.node += nodes;
    observation.landmark += landmarks;
    graph.observations.push_back(observation);
  }
  return graph;
}

TYPED_TEST(InitialGuessTest, ExactGraphsAreRecoveredFromAnywhere) {
  using Pose = TypeParam;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    auto truth = Joined(test_support::RandomKnownGraph<Pose>(40, 30, 10, 0.0, &random),
                        test_support::RandomKnownGraph<Pose>(15, 3, 2, 0.0, &random));
    if (seed % 2 == 1) truth.fixed = {3, 8, 50};
    auto graph = truth;
    test_support::Scramble(&graph, &random);
    SetSpanningTreeGuess(&graph);
    this->ExpectSame(graph, truth, 1e-9);
    test_support::Scramble(&graph, &random);
    ASSERT_TRUE(SetChordalGuess(&graph));
    this->ExpectSame(graph, truth, 1e-9);
  }
}

TYPED_TEST(InitialGuessTest, RingsOfHalfTurnsAreRecovered) {
  using Pose = TypeParam;
  std::mt19937 random(1);
  PoseGraph<Pose> truth;
  for (int i = 0; i < 8; ++i) {
    const auto t = test_support::RandomVector<typename Pose::Point>(&random);
    truth.poses.push_back(
        test_support::PoseWithAngle<Pose>(t, i % 2 == 0 ? 0.0 : std::numbers::pi, &random));
  }
  for (int i = 0; i < 8; ++i) {
    const int next = (i + 1) % 8;
    truth.constraints.push_back({i, next,
                                 truth.poses[static_cast<std::size_t>(i)].Inverse() *
                                     truth.poses[static_cast<std::size_t>(next)]});
  }
  auto graph = truth;
  test_support::Scramble(&graph, &random);
  SetSpanningTreeGuess(&graph);
  this->ExpectSame(graph, truth, 1e-9);
  test_support::Scramble(&graph, &random);
  ASSERT_TRUE(SetChordalGuess(&graph));
  this->ExpectSame(graph, truth, 1e-9);
}

TYPED_TEST(InitialGuessTest, HeldNodesAndUnseenLandmarksStay) {
  using Pose = TypeParam;
  std::mt19937 random(2);
  auto graph = test_support::RandomKnownGraph<Pose>(20, 10, 3, 0.1, &random);
  graph.fixed = {4, 11};
  graph.landmarks.push_back(Pose::Point::Constant(7.0));
  const auto before = graph;
  const auto expect_unmoved = [&] {
    for (std::size_t node : {4u, 11u}) {
      EXPECT_EQ(test_support::Distance(graph.poses[node], before.poses[node]), 0.0);
    }
    EXPECT_EQ(graph.landmarks.back(), before.landmarks.back());
  };
  SetSpanningTreeGuess(&graph);
  expect_unmoved();
  ASSERT_TRUE(SetChordalGuess(&graph));
  expect_unmoved();
}

TYPED_TEST(InitialGuessTest, TheTreeTakesTheMostCertainPath) {
  using Pose = TypeParam;
  std::mt19937 random(3);
  std::vector<Pose> T;
  for (int k = 0; k < 3; ++k) T.push_back(test_support::RandomPose<Pose>(&random));
  PoseGraph<Pose> graph;
  graph.poses.resize(3);
  graph.constraints = {{0, 1, T[0]}, {2, 1, T[1]}, {0, 2, T[2]}};
  graph.constraints[2].information *= 0.6;  // one step is better than two that are a bit better
  SetSpanningTreeGuess(&graph);
  EXPECT_LE(test_support::Distance(graph.poses[2], T[2]), 1e-12);
  graph.constraints[2].information *= 0.6;
  SetSpanningTreeGuess(&graph);
  EXPECT_LE(test_support::Distance(graph.poses[2], T[0] * T[1].Inverse()), 1e-12);

  graph.constraints[1].robust = true;
  SetSpanningTreeGuess(&graph);
  EXPECT_LE(test_support::Distance(graph.poses[2], T[2]), 1e-12);
  graph.constraints[2].information.setZero();
  SetSpanningTreeGuess(&graph);
  EXPECT_LE(test_support::Distance(graph.poses[2], T[2]), 1e-12)
      << "unknown is better than possibly wrong";
}

TYPED_TEST(InitialGuessTest, ALandmarkStartsWhereItsMostCertainObservationPutsIt) {
  using Pose = TypeParam;
  using Point = typename Pose::Point;
  PoseGraph<Pose> graph;
  graph.poses.resize(1);
  graph.landmarks = {Point::Constant(9.0)};
  for (int k = 0; k < 3; ++k) {
    LandmarkObservation<Pose> observation;
    observation.p_node = Point::Constant(k);
    observation.information *= 1.0 + k;
    observation.robust = k == 2;
    graph.observations.push_back(observation);
  }
  SetSpanningTreeGuess(&graph);
  EXPECT_EQ(graph.landmarks[0], Point::Constant(1.0));
}

/// The rotations by dense least squares: one row for each entry of (R_to - R_from R_from_to).
template <typename Pose>
std::vector<Eigen::MatrixXd> DenseRelaxation(const PoseGraph<Pose>& graph) {
  constexpr int kDim = Pose::Point::RowsAtCompileTime;
  constexpr int kEntries = kDim * kDim;
  const auto unknowns = static_cast<Eigen::Index>(kEntries * graph.poses.size());
  const auto rows = static_cast<Eigen::Index>(kEntries * graph.constraints.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, unknowns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto& c = graph.constraints[static_cast<std::size_t>(i / kEntries)];
    const double root = std::sqrt(c.information(Pose::kDof - 1, Pose::kDof - 1));
    const Eigen::Index row = i % kEntries / kDim;
    const Eigen::Index col = i % kDim;
    A(i, kEntries * c.to + kDim * row + col) += root;
    for (int k = 0; k < kDim; ++k) {
      A(i, kEntries * c.from + kDim * row + k) -= root * c.T_from_to.rotation()(k, col);
    }
  }
  Eigen::VectorXd known(kEntries);
  for (int k = 0; k < kEntries; ++k) known[k] = graph.poses[0].rotation()(k / kDim, k % kDim);
  const Eigen::VectorXd x =
      A.rightCols(unknowns - kEntries).colPivHouseholderQr().solve(-A.leftCols(kEntries) * known);
  std::vector<Eigen::MatrixXd> rotations;
  for (std::size_t i = 0; i + 1 < graph.poses.size(); ++i) {
    const double* data = x.data() + kEntries * i;
    rotations.emplace_back(
        Eigen::Map<const Eigen::Matrix<double, kDim, kDim, Eigen::RowMajor>>(data));
  }
  return rotations;
}

TYPED_TEST(InitialGuessTest, ChordalRotationsAreThoseNearestToTheDenseRelaxation) {
  using Pose = TypeParam;
  for (unsigned seed = 0; seed < 5; ++seed) {
    std::mt19937 random(seed);
    auto graph = test_support::RandomKnownGraph<Pose>(12, 10, 0, 0.2, &random);
    double weight = 1.0;
    for (auto& constraint : graph.constraints) {
      constraint.information = (weight += 0.3) * Constraint<Pose>::Information::Identity();
    }
    ASSERT_TRUE(SetChordalGuess(&graph));
    const auto relaxed = DenseRelaxation(graph);
    for (std::size_t i = 0; i < relaxed.size(); ++i) {
      // Of all rotations the nearest to M is the R with R^T M symmetric and, but for one
      // eigenvalue, positive: by the polar decomposition.
      const Eigen::MatrixXd S = graph.poses[i + 1].rotation().transpose() * relaxed[i];
      EXPECT_LE((S - S.transpose()).norm(), 1e-9) << "seed " << seed;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (S + S.transpose()));
      EXPECT_GT(solver.eigenvalues()[0] + solver.eigenvalues()[1], 0.0) << "seed " << seed;
      EXPECT_EQ(solver.eigenvalues().size(), TestFixture::kSize);
    }
  }
}

TYPED_TEST(InitialGuessTest, GrossOutliersHardlyMoveAChordalGuess) {
  using Pose = TypeParam;
  for (unsigned seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto truth = test_support::RandomKnownGraph<Pose>(40, 30, 6, 0.0, &random);
    auto graph = truth;
    for (std::size_t k = 39; k < graph.constraints.size(); ++k) {  // behind the chain
      graph.constraints[k].robust = true;
      if (k % 3 == 0) graph.constraints[k].T_from_to = test_support::RandomPose<Pose>(&random, 5.0);
    }
    for (std::size_t k = 0; k < graph.observations.size(); ++k) {
      graph.observations[k].robust = k % 4 == 3;
      if (graph.observations[k].robust) graph.observations[k].p_node.array() += 9.0;
    }
    test_support::Scramble(&graph, &random);
    ASSERT_TRUE(SetChordalGuess(&graph));
    this->ExpectSame(graph, truth, 0.2);
  }
}

TYPED_TEST(InitialGuessTest, WhatOnlyRobustConstraintsJoinIsPlacedByThem) {
  using Pose = TypeParam;
  std::mt19937 random(8);
  const auto truth = test_support::RandomKnownGraph<Pose>(20, 10, 4, 0.0, &random);
  auto graph = truth;
  for (std::size_t k = 9; k < graph.constraints.size(); ++k) graph.constraints[k].robust = true;
  for (auto& observation : graph.observations) observation.robust = true;
  test_support::Scramble(&graph, &random);
  ASSERT_TRUE(SetChordalGuess(&graph));
  this->ExpectSame(graph, truth, 1e-6);
}

TYPED_TEST(InitialGuessTest, ChordalPositionsMinimizeFGivenTheRotations) {
  using Pose = TypeParam;
  using Point = typename Pose::Point;
  std::mt19937 random(7);
  auto graph = test_support::RandomKnownGraph<Pose>(15, 15, 4, 0.2, &random);
  graph.fixed = {2, 9};
  ASSERT_TRUE(SetChordalGuess(&graph));
  // F is quadratic in positions: its minimum is where it grows in all directions alike.
  constexpr double kStep = 0.1;
  const double F = TotalChi2(graph);
  const auto expect_minimum = [&](const auto& move) {
    for (int k = 0; k < TestFixture::kSize; ++k) {
      move(Point(kStep * Point::Unit(k)));
      const double above = TotalChi2(graph);
      move(Point(-2.0 * kStep * Point::Unit(k)));
      EXPECT_NEAR(TotalChi2(graph), above, 1e-9 * F);
      EXPECT_GT(above, F);
      move(Point(kStep * Point::Unit(k)));
    }
  };
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    if (i == 2 || i == 9) continue;
    expect_minimum([&](const Point& d) {
      typename Pose::Tangent tangent = Pose::Tangent::Zero();
      tangent.template head<TestFixture::kSize>() = graph.poses[i].rotation().transpose() * d;
      graph.poses[i] = graph.poses[i].Boxplus(tangent);
    });
  }
  for (Point& landmark : graph.landmarks) expect_minimum([&](const Point& d) { landmark += d; });
}

TYPED_TEST(InitialGuessTest, WithoutInformationThereIsNoChordalGuess) {
  using Pose = TypeParam;
  std::mt19937 random(4);
  for (bool rotation : {true, false}) {
    auto graph = test_support::RandomKnownGraph<Pose>(6, 0, 2, 0.1, &random);
    auto& information = graph.constraints.back().information;
    if (rotation) {
      information.template rightCols<Pose::kDof - TestFixture::kSize>().setZero();
      information.template bottomRows<Pose::kDof - TestFixture::kSize>().setZero();
    } else {
      information.template leftCols<TestFixture::kSize>().setZero();
      information.template topRows<TestFixture::kSize>().setZero();
      graph.observations.clear();
    }
    const auto before = graph;
    EXPECT_FALSE(SetChordalGuess(&graph));
    this->ExpectSame(graph, before, 0.0);
    SetSpanningTreeGuess(&graph);
    EXPECT_TRUE(std::isfinite(TotalChi2(graph)));
  }
}

TYPED_TEST(InitialGuessTest, PartsJoinedByLandmarksAloneKeepTheirFirstNodesHeading) {
  using Pose = TypeParam;
  std::mt19937 random(5);
  auto truth = Joined(test_support::RandomKnownGraph<Pose>(6, 3, 3, 0.0, &random),
                      test_support::RandomKnownGraph<Pose>(5, 3, 0, 0.0, &random));
  for (int landmark = 0; landmark < 3; ++landmark) {
    LandmarkObservation<Pose> observation;
    observation.node = 6;
    observation.landmark = landmark;
    observation.p_node =
        truth.poses[6].Inverse() * truth.landmarks[static_cast<std::size_t>(landmark)];
    truth.observations.push_back(observation);
  }
  auto graph = truth;
  test_support::Scramble(&graph, &random);
  graph.poses[6] = truth.poses[6] * Pose().Boxplus(Pose::Tangent::Unit(0));
  const Pose root = graph.poses[6];
  SetSpanningTreeGuess(&graph);
  EXPECT_EQ(test_support::Distance(graph.poses[6], root), 0.0);
  ASSERT_TRUE(SetChordalGuess(&graph));
  this->ExpectSame(graph, truth, 1e-9);
}

TYPED_TEST(InitialGuessTest, NothingToMoveIsNoFailure) {
  PoseGraph<TypeParam> graph;
  SetSpanningTreeGuess(&graph);
  EXPECT_TRUE(SetChordalGuess(&graph));
  graph.poses.resize(2);
  graph.landmarks.resize(1);
  SetSpanningTreeGuess(&graph);
  EXPECT_TRUE(SetChordalGuess(&graph));
}

TYPED_TEST(InitialGuessTest, RefusesABrokenGraph) {
  PoseGraph<TypeParam> graph;
  graph.constraints.push_back({0, 1, TypeParam()});
  EXPECT_THROW(SetSpanningTreeGuess(&graph), Error);
  EXPECT_THROW((void)SetChordalGuess(&graph), Error);
}

}  // namespace
}  // namespace loopgrid
