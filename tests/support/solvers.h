#pragma once

#include <string>

#include <gtest/gtest.h>

#include "backend/graph/pose_graph.h"
#include "backend/solve/optimizer.h"
#include "backend/solve/optimizer_options.h"
#include "tests/support/poses.h"

namespace loopgrid::test_support {

/// A type for each kind of pose and method: for tests that are typed by both.
template <typename P, Method kM>
struct Solver {
  using Pose = P;
  static constexpr Method kMethod = kM;
};

struct SolverName {
  template <typename S>
  static std::string GetName(int) {
    const std::string pose = test_support::PoseName::GetName<typename S::Pose>(0);
    if (S::kMethod == Method::kGaussNewton) return pose + "_GaussNewton";
    return pose + (S::kMethod == Method::kDogLeg ? "_DogLeg" : "_LevenbergMarquardt");
  }
};

using AllSolvers =
    ::testing::Types<Solver<SE2, Method::kLevenbergMarquardt>, Solver<SE2, Method::kGaussNewton>,
                     Solver<SE2, Method::kDogLeg>, Solver<SE3, Method::kLevenbergMarquardt>,
                     Solver<SE3, Method::kGaussNewton>, Solver<SE3, Method::kDogLeg>>;

/// A test that is typed by AllSolvers.
template <typename S>
class SolverTest : public ::testing::Test {
 protected:
  SolverTest() { options_.method = S::kMethod; }

  OptimizerResult Optimize(PoseGraph<typename S::Pose>* graph) const {
    return Optimizer<typename S::Pose>(options_).Optimize(graph);
  }

  OptimizerOptions options_;
};

}  // namespace loopgrid::test_support
