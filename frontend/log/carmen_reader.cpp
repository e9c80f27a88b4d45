#include "frontend/log/carmen_reader.h"

#include <utility>

namespace loopgrid {

CarmenReader::CarmenReader(LineReader lines, const LogReaderOptions& options)
    : lines_(std::move(lines)), options_(options) {}

bool CarmenReader::Next(Observation* observation) {
  while (settled_ == 0 && ReadLine()) {
  }
  if (settled_ == 0) {  // the end: nothing more will be known about the mount
    mount_.Decide();
    SettleMounts();
  }
  if (pending_.empty()) return false;
  *observation = std::move(pending_.front());
  pending_.pop_front();
  --settled_;
  ++statistics_.scans;
  return true;
}

bool CarmenReader::ReadLine() {
  std::string_view line;
  try {
    if (!lines_.Next(&line)) return false;
  } catch (const Error& error) {
    if (statistics_.lines == 0) throw;
    CountMalformed(error.what(), options_, &statistics_);
    return false;
  }
  ++statistics_.lines;
  if (lines_.too_long()) {
    CountMalformed(lines_.Where() + "the line is too long", options_, &statistics_);
    return true;
  }
  switch (interpreter_.Read(line, lines_.terminated())) {
    case CarmenMeaning::kScan:
      AddScan();
      break;
    case CarmenMeaning::kOdometry:
      ++statistics_.odometry;
      break;
    case CarmenMeaning::kParameter:
      ++statistics_.parameters;
      break;
    case CarmenMeaning::kOtherLaser:
    case CarmenMeaning::kNothing:
      ++statistics_.ignored;
      break;
    case CarmenMeaning::kMalformed:
      CountMalformed(lines_.Where() + interpreter_.problem(), options_, &statistics_);
      break;
  }
  return true;
}

void CarmenReader::AddScan() {
  const CarmenLaserMessage& message = interpreter_.message();
  const CarmenLaserParameters& parameters = interpreter_.parameters().Of(message.tag);
  if (message.tag != mount_of_) {
    mount_.Decide();
    SettleMounts();
    mount_of_ = message.tag;
    mount_ = LaserMount(parameters.T_robot_laser());
  }
  if (parameters.has_mount || !message.has_poses) {
    mount_.Set(parameters.T_robot_laser());
  } else {
    mount_.Add(message.T_odom_laser, message.T_odom_robot);
  }
  pending_.push_back(interpreter_.MakeObservation());
  if (mount_.decided()) SettleMounts();
}

void CarmenReader::SettleMounts() {
  for (; settled_ < pending_.size(); ++settled_) {
    pending_[settled_].scan.T_robot_laser = mount_.T_robot_laser();
  }
}

}  // namespace loopgrid
