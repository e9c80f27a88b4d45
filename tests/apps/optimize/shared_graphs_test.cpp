// `loopgrid optimize` on public graphs with known optima, from the starts in the files. They are
// not part of the project. The environment variable LOOPGRID_DATA names their folder.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "apps/output/trace_csv.h"
#include "tests/apps/program.h"
#include "tests/support/recordings.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::ProgramResult;
using test_support::RunProgram;
using test_support::TemporaryDirectory;

struct Optimum {
  const char* graph;
  int dimensions;
  double error;
};

std::ostream& operator<<(std::ostream& stream, const Optimum& optimum) {
  return stream << optimum.graph;
}

class SharedGraphTest : public ::testing::TestWithParam<Optimum> {};

TEST_P(SharedGraphTest, IsOptimisedToItsKnownOptimumAndStaysThere) {
  const Optimum& optimum = GetParam();
  LOOPGRID_REQUIRE_RECORDING(graph, std::string("graphs/") + optimum.graph);
  const TemporaryDirectory folder;
  // The name decides the format: round trips of both.
  const bool is_toro = std::string(optimum.graph).ends_with(".graph");
  const std::string out = folder.File(is_toro ? "out.graph.gz" : "out.g2o.gz");
  const ProgramResult result = RunProgram({"optimize", graph, "--out", out, "--json"});
  ASSERT_EQ(result.status, 0) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(report["graph"]["dimensions"], optimum.dimensions);
  EXPECT_EQ(report["converged"], true);
  EXPECT_EQ(report["optimality"]["is_global"], true);
  EXPECT_LE(report["error"]["after"], optimum.error * (1.0 + 1e-6));

  const ProgramResult again = RunProgram({"optimize", out, "--init", "none", "--json"});
  ASSERT_EQ(again.status, 0) << again.errors;
  const json second = json::parse(again.output);
  EXPECT_LE(second["iterations"], is_toro ? 1 : 0);
  EXPECT_NEAR(second["error"]["after"], report["error"]["after"], 1e-8 * optimum.error);
}

INSTANTIATE_TEST_SUITE_P(All, SharedGraphTest,
                         ::testing::Values(Optimum{"intel.g2o", 2, 45.004696},
                                           Optimum{"fr079.graph", 2, 37.599116},
                                           Optimum{"m3500-hard-start.g2o", 2, 137.912951},
                                           Optimum{"sphere2500.g2o", 3, 727.149472},
                                           Optimum{"sphere-mednoise.graph", 3, 395.006212}));

TEST(SharedGraphs, EulerAnglesStallWhereTheManifoldConverges) {
  LOOPGRID_REQUIRE_RECORDING(graph, "graphs/sphere2500.g2o");
  const TemporaryDirectory folder;
  const auto optimize = [&](const char* parametrization) {
    const std::string trace = folder.File("trace.csv");
    const ProgramResult result =
        RunProgram({"optimize", graph, "--init", "none", "--parametrization", parametrization,
                    "--max-iterations", "25", "--trace", trace});
    EXPECT_EQ(result.status, 0) << result.errors;
    return ReadTraceCsv(trace).back().y();
  };
  EXPECT_NEAR(optimize("manifold"), 727.15, 0.01);
  EXPECT_GT(optimize("euler"), 5000.0);
}

}  // namespace
}  // namespace loopgrid
