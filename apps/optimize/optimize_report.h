#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/optimize/optimize_options.h"
#include "backend/files/graph_file.h"
#include "backend/global/best_start.h"
#include "backend/global/global_optimality.h"

namespace loopgrid {

/// The report about an optimisation, as plain values.
struct OptimizeReport {
  OptimizeOptions options;

  int dimensions = 2;
  std::size_t nodes = 0;
  std::size_t landmarks = 0;
  std::size_t sequential = 0;    ///< constraints that join a node to the next one by id
  std::size_t closures = 0;      ///< all others
  std::size_t observations = 0;  ///< of landmarks
  std::size_t components = 0;
  std::vector<std::int64_t> held;       ///< ids of the nodes that did not move
  std::size_t fixed = 0;                ///< how many of these the file fixes
  std::int64_t degrees_of_freedom = 0;  ///< mean of F if the information matrices are true
  GraphNotes notes;

  double file_error = 0.0;         ///< F at the poses in the file
  std::vector<StartTrial> trials;  ///< see BestStartResult
  std::size_t best = 0;
  double final_chi2 = 0.0;  ///< TotalChi2 at the end
  std::optional<OptimalityCertificate> certificate;
  std::size_t robust = 0;  ///< constraints and observations that the loss applies to
  std::size_t outliers =
      0;  ///< of these, how many have an error beyond the loss's width at the end
  std::vector<std::string> files;  ///< written

  double reading_seconds = 0.0;
  double optimizing_seconds = 0.0;  ///< all starts, with the test for global optimality
  double marginals_seconds = 0.0;
  double writing_seconds = 0.0;  ///< drawing included
  double total_seconds = 0.0;
  double peak_memory_mb = 0.0;

  const OptimizerResult& result() const { return trials[best].result; }
};

/// One line: what the certificate says, or why there is none.
std::string ExplainOptimality(const OptimizeReport& report);

/// JSON, for programs. Only members under the key "timings" may differ between two runs on the same
/// input.
std::string FormatOptimizeJson(const OptimizeReport& report);

/// Text, for people; F with 12 digits, so that it can be compared with published optima.
std::string FormatOptimizeSummary(const OptimizeReport& report);

}  // namespace loopgrid
