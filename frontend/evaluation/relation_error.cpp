#include "frontend/evaluation/relation_error.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "frontend/evaluation/trajectory_lookup.h"

namespace loopgrid {
namespace {

constexpr double kExact = 1e-4;  // seconds
constexpr double kDegrees = 180.0 / std::numbers::pi;

RelationErrorSummaries SummarizeKind(const std::vector<RelationError>& errors, bool exact) {
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const RelationError& error : errors) {
    if (error.exact != exact) continue;
    translations.push_back(error.translation);
    rotations.push_back(error.rotation);
  }
  return {Summarize(std::move(translations)), Summarize(std::move(rotations))};
}

}  // namespace

RelationEvaluation EvaluateRelations(const Trajectory& trajectory,
                                     std::span<const Relation> relations) {
  const TrajectoryLookup lookup(trajectory);
  const auto pose_at = [&](double timestamp, bool* exact) -> std::optional<SE2> {
    if (const auto index = lookup.Nearest(timestamp, kExact)) return trajectory[*index].pose;
    *exact = false;
    return lookup.Interpolate(timestamp);
  };

  RelationEvaluation evaluation;
  for (std::size_t i = 0; i < relations.size(); ++i) {
    bool exact = true;
    const std::optional<SE2> T_map_1 = pose_at(relations[i].t1, &exact);
    const std::optional<SE2> T_map_2 = pose_at(relations[i].t2, &exact);
    if (!T_map_1 || !T_map_2) {
      ++evaluation.outside;
      continue;
    }
    const SE2& given = relations[i].T_1_2;
    const SE2 estimated = T_map_1->Inverse() * *T_map_2;
    const double translation = (estimated.translation() - given.translation()).norm();
    const double rotation = std::abs(NormalizeAngle(estimated.theta() - given.theta()));
    evaluation.errors.push_back({i, exact, translation, rotation * kDegrees});
  }
  evaluation.exact = SummarizeKind(evaluation.errors, true);
  evaluation.interpolated = SummarizeKind(evaluation.errors, false);
  return evaluation;
}

}  // namespace loopgrid
