// The optimiser on public benchmark graphs, which the project does not contain: LOOPGRID_DATA names
// the folder that has them in graphs/.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdlib>
#include <string>

#include "backend/files/graph_file.h"
#include "backend/solve/optimizer.h"

namespace loopgrid {
namespace {

struct KnownOptimum {
  const char* file;
  std::size_t nodes;
  std::size_t constraints;
  double error;
};

/// F by complex arithmetic, straight from the definition.
double PlainError(const PoseGraph<SE2>& graph) {
  using Complex = std::complex<double>;
  double sum = 0.0;
  for (const Constraint<SE2>& constraint : graph.constraints) {
    const SE2& from = graph.poses[static_cast<std::size_t>(constraint.from)];
    const SE2& to = graph.poses[static_cast<std::size_t>(constraint.to)];
    const SE2& T = constraint.T_from_to;
    const Complex step =
        Complex(to.x() - from.x(), to.y() - from.y()) * std::polar(1.0, -from.theta());
    const Complex shift = (step - Complex(T.x(), T.y())) * std::polar(1.0, -T.theta());
    const double turn = std::arg(std::polar(1.0, to.theta() - from.theta() - T.theta()));
    const double e[3] = {shift.real(), shift.imag(), turn};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) sum += e[i] * constraint.information(i, j) * e[j];
    }
  }
  return sum;
}

class KnownOptimumTest : public ::testing::TestWithParam<KnownOptimum> {};

TEST_P(KnownOptimumTest, IsReachedFromTheStartInTheFile) {
  const char* folder = std::getenv("LOOPGRID_DATA");
  if (folder == nullptr) GTEST_SKIP() << "LOOPGRID_DATA is not set";
  PoseGraph<SE2> graph = ReadGraphOf<SE2>(std::string(folder) + "/graphs/" + GetParam().file).graph;
  EXPECT_EQ(graph.poses.size(), GetParam().nodes);
  EXPECT_EQ(graph.constraints.size(), GetParam().constraints);

  Optimizer<SE2> optimizer;
  const double start = PlainError(graph);
  const OptimizerResult result = optimizer.Optimize(&graph);
  EXPECT_NEAR(result.initial_error, start, 1e-9 * start);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_LE(result.final_error, GetParam().error * (1.0 + 1e-6));
  EXPECT_NEAR(PlainError(graph), result.final_error, 1e-9 * result.final_error);
  EXPECT_TRUE(optimizer.ComputeMarginals(graph).has_value());
}

INSTANTIATE_TEST_SUITE_P(Graphs, KnownOptimumTest,
                         ::testing::Values(KnownOptimum{"intel.g2o", 1728, 2512, 45.004696},
                                           KnownOptimum{"intel-943.g2o", 943, 1837, 546.461112},
                                           KnownOptimum{"manhattan3500.g2o", 3500, 5598,
                                                        146.076613},
                                           KnownOptimum{"city10000.g2o", 10000, 20687, 511.985164}),
                         [](const auto& test) {
                           std::string name = test.param.file;
                           name.resize(name.find('.'));
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace loopgrid
