#include "frontend/evaluation/reference_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "frontend/log/observation/plausible_pose.h"

namespace loopgrid {
namespace {

bool CanBeStampedPose(const NumberTable::Row& row) {
  constexpr double kRounding = 0.01;
  const auto& [time, x, y, z, qx, qy, qz, qw] = row.numbers;
  if (!IsPlausiblePose(x, y, 0.0)) return false;
  const bool only_w = qx == 0.0 && qy == 0.0 && qz == 0.0;
  if (only_w) return std::abs(std::abs(qw) - 1.0) <= kRounding;
  return IsNearUnitQuaternion(qx, qy, qz, qw);
}

}  // namespace

ReferenceKind GuessReferenceKind(const NumberTable& table) {
  const auto poses = std::count_if(table.rows.begin(), table.rows.end(), CanBeStampedPose);
  const bool most = 2 * static_cast<std::size_t>(poses) > table.rows.size();
  return most ? ReferenceKind::kTrajectory : ReferenceKind::kRelations;
}

Reference ReadReference(const std::string& path, std::optional<ReferenceKind> kind) {
  const NumberTable table = ReadNumberTable(path);
  if (kind.value_or(GuessReferenceKind(table)) == ReferenceKind::kTrajectory) {
    return TrajectoryFrom(table);
  }
  return RelationsFrom(table);
}

}  // namespace loopgrid
