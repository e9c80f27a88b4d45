#include "frontend/evaluation/relations_file.h"

#include <array>

#include "backend/base/line_reader.h"
#include "frontend/evaluation/number_lines.h"
#include "frontend/log/observation/plausible_pose.h"

namespace loopgrid {

std::vector<Relation> ReadRelationsFile(const std::string& path) {
  std::vector<Relation> relations;
  LineReader lines(path);
  std::array<double, 8> fields{};
  while (NextNumberLine(&lines, fields)) {
    const auto& [t1, t2, x, y, z, roll, pitch, yaw] = fields;
    if (!IsPlausiblePose(x, y, yaw)) throw lines.ErrorHere("the pose is out of any bounds");
    relations.push_back({t1, t2, SE2(x, y, yaw)});
  }
  if (relations.empty()) throw Error(ErrorCode::kInput, path + ": holds no relation");
  return relations;
}

}  // namespace loopgrid
