#include "frontend/log/carmen/carmen_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "backend/base/parse_number.h"
#include "frontend/log/observation/plausible_pose.h"

namespace loopgrid {
namespace {

constexpr std::array<std::pair<std::string_view, CarmenTag>, 10> kTags = {{
    {"FLASER", CarmenTag::kFlaser},
    {"ODOM", CarmenTag::kOdom},
    {"ROBOTLASER1", CarmenTag::kRobotLaser1},
    {"RAWLASER1", CarmenTag::kRawLaser1},
    {"RLASER", CarmenTag::kRlaser},
    {"ROBOTLASER2", CarmenTag::kRobotLaser2},
    {"RAWLASER2", CarmenTag::kRawLaser2},
    {"RAWLASER3", CarmenTag::kRawLaser3},
    {"RAWLASER4", CarmenTag::kRawLaser4},
    {"PARAM", CarmenTag::kParam},
}};

std::string ParsePose(FieldCursor* fields, const char* whose, SE2* pose) {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;
  if (!fields->Next(&x) || !fields->Next(&y) || !fields->Next(&theta)) {
    return std::string("the pose of the ") + whose + " is not three finite numbers";
  }
  if (!IsPlausiblePose(x, y, theta)) {
    return std::string("the pose of the ") + whose + " is out of any bounds";
  }
  *pose = SE2(x, y, theta);
  return {};
}

std::string ParseCount(FieldCursor* fields, const char* what, int smallest, int* count) {
  if (!fields->Next(count)) return std::string("the number of ") + what + " is not a number";
  if (*count < smallest || *count > kMaxReadings) {
    return std::string("the number of ") + what + " is " + std::to_string(*count) + ", not " +
           std::to_string(smallest) + " to " + std::to_string(kMaxReadings);
  }
  return {};
}

std::string ParseRanges(FieldCursor* fields, std::vector<float>* ranges) {
  int count = 0;
  std::string problem = ParseCount(fields, "readings", 1, &count);
  if (!problem.empty()) return problem;
  ranges->resize(static_cast<std::size_t>(count));
  for (float& range : *ranges) {
    if (!fields->NextDecimal(&range) || !(range >= 0.0F)) {
      const auto index = &range - ranges->data();
      return "reading " + std::to_string(index + 1) + " of " + std::to_string(count) +
             " is not a finite number >= 0";
    }
    range = std::min(range, kFarthestReading);
  }
  return {};
}

std::string SkipRemissions(FieldCursor* fields) {
  int count = 0;
  std::string problem = ParseCount(fields, "remissions", 0, &count);
  for (int i = 0; problem.empty() && i < count; ++i) fields->Next();
  return problem;
}

/// Reads the description of the laser at the beginning of ROBOTLASER and RAWLASER, up to the
/// readings.
std::string ParseSensor(FieldCursor* fields, CarmenLaserMessage* message) {
  constexpr double kFullTurn = 2.0 * std::numbers::pi;
  double laser_type = 0.0;
  double accuracy = 0.0;
  double remission_mode = 0.0;
  if (!fields->Next(&laser_type) || !fields->Next(&message->start_angle) ||
      !fields->Next(&message->field_of_view) || !fields->Next(&message->angular_resolution) ||
      !fields->Next(&message->max_range) || !fields->Next(&accuracy) ||
      !fields->Next(&remission_mode)) {
    return "the laser's configuration is not seven finite numbers";
  }
  if (std::abs(message->start_angle) > kFullTurn || message->field_of_view < 0.0 ||
      message->field_of_view > 1.01 * kFullTurn ||
      std::abs(message->angular_resolution) > kFullTurn || message->max_range < 0.0) {
    return "the laser's angles or its maximum range are out of any bounds";
  }
  message->has_angles = true;
  return {};
}

std::string ParsePoses(FieldCursor* fields, CarmenLaserMessage* message) {
  fields->SkipBlanks();
  message->laser_pose_begin = fields->offset();
  std::string problem = ParsePose(fields, "laser", &message->T_odom_laser);
  if (!problem.empty()) return problem;
  message->laser_pose_end = fields->offset();
  message->has_poses = true;
  return ParsePose(fields, "robot", &message->T_odom_robot);
}

/// laser_tv, laser_rv, forward_safety_dist, side_safety_dist, turn_axis.
void SkipMotionFields(FieldCursor* fields) {
  for (int i = 0; i < 5; ++i) fields->Next();
}

bool IsRaw(CarmenTag tag) { return tag >= CarmenTag::kRawLaser1; }

bool IsOldStyle(CarmenTag tag) { return tag == CarmenTag::kFlaser || tag == CarmenTag::kRlaser; }

}  // namespace

CarmenTag TagOf(std::string_view line) {
  const std::string_view word = FieldCursor(line).Next();
  for (const auto& [name, tag] : kTags) {
    if (word == name) return tag;
  }
  return CarmenTag::kOther;
}

std::string ParseLaserLine(std::string_view line, CarmenLaserMessage* message) {
  FieldCursor fields(line);
  message->tag = TagOf(fields.Next());
  message->has_poses = false;
  message->has_angles = false;
  message->start_angle = message->field_of_view = message->angular_resolution = 0.0;
  message->max_range = 0.0;

  const bool old_style = IsOldStyle(message->tag);
  std::string problem;
  if (!old_style) problem = ParseSensor(&fields, message);
  if (problem.empty()) problem = ParseRanges(&fields, &message->ranges);
  if (problem.empty() && !old_style) problem = SkipRemissions(&fields);
  if (problem.empty() && !IsRaw(message->tag)) {
    problem = ParsePoses(&fields, message);
    if (!old_style) SkipMotionFields(&fields);
  }
  if (problem.empty() && !fields.Next(&message->timestamp)) {
    problem = "the time stamp is missing or not a finite number";
  }
  return problem;
}

std::string ParseOdometryLine(std::string_view line, SE2* T_odom_robot) {
  FieldCursor fields(line);
  fields.Next();
  return ParsePose(&fields, "robot", T_odom_robot);
}

}  // namespace loopgrid
