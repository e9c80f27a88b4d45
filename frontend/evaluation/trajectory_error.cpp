#include "frontend/evaluation/trajectory_error.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "frontend/evaluation/trajectory_lookup.h"

namespace loopgrid {
namespace {

struct PosePair {
  SE2 estimate;
  SE2 reference;
};

/// The rigid motion that minimises the sum of squared distances between the positions.
SE2 Align(const std::vector<PosePair>& pairs) {
  const auto count = static_cast<double>(pairs.size());
  Eigen::Vector2d mean_estimate = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_reference = Eigen::Vector2d::Zero();
  for (const PosePair& pair : pairs) {
    mean_estimate += pair.estimate.translation() / count;
    mean_reference += pair.reference.translation() / count;
  }
  double dot = 0.0;
  double cross = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector2d a = pair.estimate.translation() - mean_estimate;
    const Eigen::Vector2d b = pair.reference.translation() - mean_reference;
    dot += a.dot(b);
    cross += a.x() * b.y() - a.y() * b.x();
  }
  const SE2 rotation(0.0, 0.0, std::atan2(cross, dot));
  const Eigen::Vector2d translation = mean_reference - rotation * mean_estimate;
  return SE2(translation.x(), translation.y(), rotation.theta());
}

}  // namespace

TrajectoryEvaluation EvaluateTrajectory(const Trajectory& estimate, const Trajectory& reference,
                                        double tolerance) {
  const TrajectoryLookup lookup(estimate);
  std::vector<PosePair> pairs;
  for (const StampedPose& stamped : reference) {
    const auto index = lookup.Nearest(stamped.timestamp, tolerance);
    if (index) pairs.push_back({estimate[*index].pose, stamped.pose});
  }
  TrajectoryEvaluation evaluation;
  evaluation.unmatched = reference.size() - pairs.size();
  if (pairs.empty()) return evaluation;
  evaluation.T_reference_estimate = Align(pairs);
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const PosePair& pair : pairs) {
    const SE2 aligned = evaluation.T_reference_estimate * pair.estimate;
    translations.push_back((aligned.translation() - pair.reference.translation()).norm());
    rotations.push_back(std::abs(NormalizeAngle(aligned.theta() - pair.reference.theta())) * 180.0 /
                        std::numbers::pi);
  }
  evaluation.translation = Summarize(std::move(translations));
  evaluation.rotation = Summarize(std::move(rotations));
  return evaluation;
}

}  // namespace loopgrid
