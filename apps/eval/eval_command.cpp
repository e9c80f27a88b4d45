#include "apps/eval/eval_command.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/output/standard_output.h"
#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "frontend/evaluation/number_lines.h"
#include "frontend/evaluation/relation_error.h"
#include "frontend/evaluation/relations_file.h"
#include "frontend/evaluation/trajectory_error.h"
#include "frontend/evaluation/tum_file.h"

namespace loopgrid {
namespace {

using Json = nlohmann::ordered_json;

/// Both formats have eight numbers a line; only of a trajectory are the last four always a unit
/// quaternion.
bool IsTrajectoryFile(const std::string& path) {
  constexpr int kLinesToTry = 20;
  constexpr double kTolerance = 0.01;
  LineReader lines(path);
  std::array<double, 8> fields{};
  for (int i = 0; i < kLinesToTry && NextNumberLine(&lines, fields); ++i) {
    const auto& [time, x, y, z, qx, qy, qz, qw] = fields;
    const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
    if (std::abs(norm - 1.0) > kTolerance) return false;
  }
  return true;
}

Json SummaryJson(const ErrorSummary& summary) {
  return {{"mean", summary.mean},     {"std", summary.standard_deviation},
          {"rms", summary.rms},       {"squared_mean", summary.squared_mean},
          {"median", summary.median}, {"max", summary.maximum}};
}

std::string SummaryLine(const char* name, const ErrorSummary& summary, const char* unit) {
  return fmt::format(
      "  {:<12} {:.4f} +- {:.4f} {unit}, squared mean {:.6f} {unit}^2, rms {:.4f} {unit}, "
      "median {:.4f} {unit}, max {:.4f} {unit}\n",
      name, summary.mean, summary.standard_deviation, summary.squared_mean, summary.rms,
      summary.median, summary.maximum, fmt::arg("unit", unit));
}

Json RelationsJson(const RelationErrorSummaries& errors) {
  return {{"count", errors.translation.count},
          {"translation_m", SummaryJson(errors.translation)},
          {"rotation_deg", SummaryJson(errors.rotation)}};
}

std::string RelationsText(const char* kind, const RelationErrorSummaries& errors) {
  std::string text = fmt::format("{:<13} {} relations\n", kind, errors.translation.count);
  if (errors.translation.count == 0) return text;
  return text + SummaryLine("translation", errors.translation, "m") +
         SummaryLine("rotation", errors.rotation, "deg");
}

std::string CompareWithRelations(const EvalOptions& options, const Trajectory& estimate) {
  const RelationEvaluation result =
      EvaluateRelations(estimate, ReadRelationsFile(options.reference));
  if (result.errors.empty()) {
    throw Error(ErrorCode::kInput,
                options.reference + ": no relation lies within the times of " + options.estimate);
  }
  if (options.json) {
    const Json json = {{"metric", "relations"},
                       {"exact", RelationsJson(result.exact)},
                       {"interpolated", RelationsJson(result.interpolated)},
                       {"outside", result.outside}};
    return json.dump(2) + '\n';
  }
  return RelationsText("exact", result.exact) + RelationsText("interpolated", result.interpolated) +
         fmt::format("{:<13} {} relations\n", "outside", result.outside);
}

std::string CompareWithTrajectory(const EvalOptions& options, const Trajectory& estimate) {
  const TrajectoryEvaluation result = EvaluateTrajectory(estimate, ReadTumFile(options.reference));
  if (result.translation.count == 0) {
    throw Error(ErrorCode::kInput,
                options.reference + ": no pose has the time of one of " + options.estimate);
  }
  if (options.json) {
    const SE2& alignment = result.T_reference_estimate;
    const Json json = {
        {"metric", "trajectory"},
        {"count", result.translation.count},
        {"translation_m", SummaryJson(result.translation)},
        {"rotation_deg", SummaryJson(result.rotation)},
        {"unmatched", result.unmatched},
        {"alignment", {{"x", alignment.x()}, {"y", alignment.y()}, {"theta", alignment.theta()}}}};
    return json.dump(2) + '\n';
  }
  return fmt::format("{:<13} {} poses\n", "compared", result.translation.count) +
         SummaryLine("translation", result.translation, "m") +
         SummaryLine("rotation", result.rotation, "deg") +
         fmt::format("{:<13} {} poses of the reference\n", "unmatched", result.unmatched);
}

}  // namespace

void EvalCommand(const EvalOptions& options) {
  const Trajectory estimate = ReadTumFile(options.estimate);
  PrintToStandardOutput(IsTrajectoryFile(options.reference)
                            ? CompareWithTrajectory(options, estimate)
                            : CompareWithRelations(options, estimate));
}

}  // namespace loopgrid
