#include "frontend/log/carmen/carmen_decoder.h"

#include <utility>

namespace loopgrid {

CarmenDecoder::CarmenDecoder(std::string name, const LogReaderOptions& options)
    : name_(std::move(name)), options_(options) {}

void CarmenDecoder::AddLine(std::string_view line, bool terminated, bool too_long) {
  ++statistics_.lines;
  if (too_long) {
    CountProblem("the line is too long");
    return;
  }
  switch (interpreter_.Read(line, terminated)) {
    case CarmenMeaning::kScan:
      AddScan();
      break;
    case CarmenMeaning::kOdometry:
      ++statistics_.odometry;
      break;
    case CarmenMeaning::kParameter:
      ++statistics_.parameters;
      break;
    case CarmenMeaning::kNewSession:
      Finish();
      new_session_ = true;
      ++statistics_.ignored;
      break;
    case CarmenMeaning::kOtherLaser:
    case CarmenMeaning::kNothing:
      ++statistics_.ignored;
      break;
    case CarmenMeaning::kMalformed:
      CountProblem(interpreter_.problem());
      break;
  }
}

void CarmenDecoder::BreakOff(const std::string& problem) {
  CountMalformed(problem, options_, &statistics_);
}

void CarmenDecoder::Finish() {
  mount_.Decide();
  SettleMounts();
}

bool CarmenDecoder::Next(Observation* observation) {
  if (settled_ == 0) return false;
  *observation = std::move(pending_.front().observation);
  observation_line_ = pending_.front().line;
  pending_.pop_front();
  --settled_;
  ++statistics_.scans;
  return true;
}

void CarmenDecoder::CountProblem(const std::string& problem) {
  CountMalformed(name_ + ":" + std::to_string(statistics_.lines) + ": " + problem, options_,
                 &statistics_);
}

void CarmenDecoder::AddScan() {
  const CarmenLaserMessage& message = interpreter_.message();
  const CarmenLaserParameters& parameters = interpreter_.parameters().Of(message.tag);
  if (message.tag != mount_of_) {
    Finish();  // the mount of the laser used so far is decided now
    mount_of_ = message.tag;
    mount_ = LaserMount(parameters.T_robot_laser());
  }
  if (parameters.has_mount || !message.has_poses) {
    mount_.Set(parameters.T_robot_laser());
  } else {
    mount_.Add(message.T_odom_laser, message.T_odom_robot);
  }
  pending_.push_back({interpreter_.MakeObservation(), statistics_.lines});
  pending_.back().observation.new_session = std::exchange(new_session_, false);
  if (mount_.decided()) SettleMounts();
}

void CarmenDecoder::SettleMounts() {
  for (; settled_ < pending_.size(); ++settled_) {
    pending_[settled_].observation.scan.T_robot_laser = mount_.T_robot_laser();
  }
}

}  // namespace loopgrid
