#include "frontend/evaluation/relations_file.h"

#include "frontend/log/observation/plausible_pose.h"

namespace loopgrid {

std::vector<Relation> RelationsFrom(const NumberTable& table) {
  std::vector<Relation> relations;
  relations.reserve(table.rows.size());
  for (const NumberTable::Row& row : table.rows) {
    const auto& [t1, t2, x, y, z, roll, pitch, yaw] = row.numbers;
    if (!IsPlausiblePose(x, y, yaw)) throw table.ErrorAt(row, "the pose is out of any bounds");
    relations.push_back({t1, t2, SE2(x, y, yaw)});
  }
  if (relations.empty()) throw Error(ErrorCode::kInput, table.path + ": holds no relation");
  return relations;
}

std::vector<Relation> ReadRelationsFile(const std::string& path) {
  return RelationsFrom(ReadNumberTable(path));
}

}  // namespace loopgrid
