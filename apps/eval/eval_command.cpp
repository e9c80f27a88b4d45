#include "apps/eval/eval_command.h"

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/output/json_writer.h"
#include "apps/output/standard_output.h"
#include "backend/base/error.h"
#include "frontend/evaluation/reference_file.h"
#include "frontend/evaluation/relation_error.h"
#include "frontend/evaluation/trajectory_error.h"
#include "frontend/evaluation/tum_file.h"

namespace loopgrid {
namespace {

bool IsForced(const EvalOptions& options) { return options.relations || options.trajectory; }

/// Says which file is compared with which, and how the second one was read.
std::string ComparisonLine(const EvalOptions& options, std::size_t poses, const char* kind,
                           std::size_t count, const char* unit) {
  return fmt::format("{:<13} {} ({} poses) with the {} {} ({} {}; {})\n", "compare",
                     options.estimate, poses, kind, options.reference, count, unit,
                     IsForced(options) ? "as told" : "known by content");
}

void AddComparison(const EvalOptions& options, const char* metric, JsonWriter* json) {
  json->Field("metric", metric)
      .Field("known_by", IsForced(options) ? "option" : "content")
      .Field("estimate", options.estimate)
      .Field("reference", options.reference);
}

void AddSummary(const char* key, const ErrorSummary& summary, JsonWriter* json) {
  json->Key(key).BeginObject();
  json->Field("mean", summary.mean)
      .Field("std", summary.standard_deviation)
      .Field("rms", summary.rms)
      .Field("squared_mean", summary.squared_mean)
      .Field("median", summary.median)
      .Field("max", summary.maximum);
  json->EndObject();
}

std::string SummaryLine(const char* name, const ErrorSummary& summary, const char* unit) {
  return fmt::format(
      "  {:<12} {:.4f} +- {:.4f} {unit}, squared mean {:.6f} {unit}^2, rms {:.4f} {unit}, "
      "median {:.4f} {unit}, max {:.4f} {unit}\n",
      name, summary.mean, summary.standard_deviation, summary.squared_mean, summary.rms,
      summary.median, summary.maximum, fmt::arg("unit", unit));
}

void AddRelations(const char* key, const RelationErrorSummaries& errors, JsonWriter* json) {
  json->Key(key).BeginObject().Field("count", errors.translation.count);
  AddSummary("translation_m", errors.translation, json);
  AddSummary("rotation_deg", errors.rotation, json);
  json->EndObject();
}

std::string RelationsText(const char* kind, const RelationErrorSummaries& errors) {
  std::string text = fmt::format("{:<13} {} relations\n", kind, errors.translation.count);
  if (errors.translation.count == 0) return text;
  return text + SummaryLine("translation", errors.translation, "m") +
         SummaryLine("rotation", errors.rotation, "deg");
}

std::string Compare(const EvalOptions& options, const Trajectory& estimate,
                    const std::vector<Relation>& relations) {
  const RelationEvaluation result = EvaluateRelations(estimate, relations);
  if (result.errors.empty()) {
    throw Error(ErrorCode::kInput,
                options.reference + ": no relation lies within the times of " + options.estimate);
  }
  if (options.json) {
    JsonWriter json(JsonWriter::Layout::kIndented);
    json.BeginObject();
    AddComparison(options, "relations", &json);
    AddRelations("exact", result.exact, &json);
    AddRelations("interpolated", result.interpolated, &json);
    json.Field("outside", result.outside).EndObject();
    return json.Take() + '\n';
  }
  return ComparisonLine(options, estimate.size(), "relations", relations.size(), "relations") +
         RelationsText("exact", result.exact) + RelationsText("interpolated", result.interpolated) +
         fmt::format("{:<13} {} relations\n", "outside", result.outside);
}

std::string FormatJson(const EvalOptions& options, const TrajectoryEvaluation& result) {
  JsonWriter json(JsonWriter::Layout::kIndented);
  json.BeginObject();
  AddComparison(options, "trajectory", &json);
  json.Field("count", result.translation.count);
  AddSummary("translation_m", result.translation, &json);
  AddSummary("rotation_deg", result.rotation, &json);
  json.Field("unmatched", result.unmatched);
  const SE2& alignment = result.T_reference_estimate;
  json.Key("alignment").BeginObject();
  json.Field("x", alignment.x()).Field("y", alignment.y()).Field("theta", alignment.theta());
  json.EndObject().EndObject();
  return json.Take() + '\n';
}

std::string Compare(const EvalOptions& options, const Trajectory& estimate,
                    const Trajectory& reference) {
  const TrajectoryEvaluation result = EvaluateTrajectory(estimate, reference);
  if (result.translation.count == 0) {
    throw Error(ErrorCode::kInput,
                options.reference + ": no pose has the time of one of " + options.estimate);
  }
  if (options.json) return FormatJson(options, result);
  return ComparisonLine(options, estimate.size(), "trajectory", reference.size(), "poses") +
         fmt::format("{:<13} {} poses\n", "compared", result.translation.count) +
         SummaryLine("translation", result.translation, "m") +
         SummaryLine("rotation", result.rotation, "deg") +
         fmt::format("{:<13} {} poses of the reference\n", "unmatched", result.unmatched);
}

std::optional<ReferenceKind> ReferenceKindOf(const EvalOptions& options) {
  if (options.relations) return ReferenceKind::kRelations;
  if (options.trajectory) return ReferenceKind::kTrajectory;
  return std::nullopt;
}

}  // namespace

void EvalOptions::Validate() const {
  if (relations && trajectory) {
    throw Error(ErrorCode::kUsage, "--relations and --reference: REFERENCE is one of them");
  }
}

void EvalCommand(const EvalOptions& options) {
  options.Validate();
  const Trajectory estimate = ReadTumFile(options.estimate);
  const Reference reference = ReadReference(options.reference, ReferenceKindOf(options));
  PrintToStandardOutput(std::visit(
      [&](const auto& content) { return Compare(options, estimate, content); }, reference));
}

}  // namespace loopgrid
