#include "frontend/log/rawlog/rawlog_reader.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <cstring>
#include <deque>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "backend/base/error.h"
#include "frontend/log/observation/beam_angles.h"
#include "frontend/log/observation/observation.h"
#include "frontend/log/observation/plausible_pose.h"
#include "frontend/log/rawlog/rawlog_stream.h"

namespace loopgrid {
namespace {

constexpr double kHorizontal = 0.1;  // radians of roll and pitch
constexpr double kSamePlace = 0.01;  // metres and radians: poses this close are of the same laser

/// Whether MRPT can make an object of a class: the class is registered and not abstract.
bool IsKnownClass(const std::string& name) {
  const mrpt::rtti::TRuntimeClassId* known = mrpt::rtti::findRegisteredClass(name);
  return known != nullptr && known->ptrCreateObject != nullptr;
}

/// The archive from which MRPT reads objects.
class Archive : public mrpt::serialization::CArchive {
 public:
  explicit Archive(RawlogStream* stream) : stream_(stream) {}

 protected:
  size_t read(void* bytes, size_t count) override {
    stream_->Read(bytes, count);
    return count;
  }
  size_t write(const void*, size_t) override { throw std::logic_error("only for reading"); }

 private:
  RawlogStream* stream_;
};

/// MRPT's messages have many lines, among them the call stack. The cause is the line after
/// "Message:".
std::string FirstMessage(const std::string& what) {
  constexpr std::string_view kLabel = "Message:";
  const std::size_t label = what.find(kLabel);
  std::size_t begin = label == what.npos ? 0 : label + kLabel.size();
  begin = std::min(what.find_first_not_of(" \t\n", begin), what.size());
  return what.substr(begin, what.find('\n', begin) - begin);
}

SE2 PlanarPose(const mrpt::poses::CPose3D& pose) { return SE2(pose.x(), pose.y(), pose.yaw()); }

SE2 ToSE2(const mrpt::poses::CPose2D& pose) { return SE2(pose.x(), pose.y(), pose.phi()); }

bool IsPlausible(const SE2& pose) { return IsPlausiblePose(pose.x(), pose.y(), pose.theta()); }

/// The value of a bool that MRPT copied from a file as a byte, which may be neither 0 nor 1.
bool IsSet(const bool& flag) {
  unsigned char byte = 0;
  std::memcpy(&byte, &flag, 1);
  return byte != 0;
}

/// Converts the readings; returns what is wrong with them, or an empty string.
std::string ConvertRanges(const mrpt::obs::CObservation2DRangeScan& from, LaserScan* scan) {
  const std::size_t count = from.getScanSize();
  if (count < 1 || count > static_cast<std::size_t>(kMaxReadings)) {
    return "a scan of " + std::to_string(count) + " readings";
  }
  const bool has_max = std::isfinite(from.maxRange) && from.maxRange > 0.0F;
  const float no_return = has_max ? std::min(from.maxRange, kFarthestReading) : kFarthestReading;
  scan->max_range = has_max ? static_cast<double>(no_return) : 0.0;
  scan->ranges.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float range = from.getScanRangeValidity(i) ? from.getScanRange(i) : no_return;
    if (!std::isfinite(range) || range < 0.0F) {
      return "reading " + std::to_string(i + 1) + " of " + std::to_string(count) +
             " is not a finite number >= 0";
    }
    scan->ranges[i] = std::min(range, kFarthestReading);
  }
  return {};
}

/// Converts the laser's pose and its beams' directions; returns what is wrong with them, or an
/// empty string. A laser mounted upside down sweeps in the opposite direction.
std::string ConvertGeometry(const mrpt::obs::CObservation2DRangeScan& from, LaserScan* scan) {
  constexpr double kPi = std::numbers::pi;
  const double aperture = from.aperture;
  if (!(aperture > 0.0 && aperture <= 2.0 * kPi + 1e-6)) return "an aperture beyond a full turn";
  const std::size_t count = scan->ranges.size();
  BeamAngles angles{-0.5 * aperture,
                    count > 1 ? aperture / (static_cast<double>(count) - 1.0) : aperture};
  // A SICK takes 180 readings at full degrees, without the last beam. MRPT's converters wrongly
  // spread them over the whole fan, both ends included.
  const bool sick = (count == 180 || count == 360) && std::abs(aperture - kPi) < 1e-3;
  if (sick) angles = UsualBeamAngles(count);
  const bool upside_down = std::cos(from.sensorPose.roll()) < 0.0;
  const double direction = IsSet(from.rightToLeft) != upside_down ? 1.0 : -1.0;
  scan->first_angle = direction * angles.first;
  scan->angle_step = direction * angles.step;
  scan->T_robot_laser = PlanarPose(from.sensorPose);
  if (!IsPlausible(scan->T_robot_laser)) return "a laser pose that is not finite";
  return {};
}

}  // namespace

class RawlogReader::Impl {
 public:
  Impl(InputFile file, const LogReaderOptions& options)
      : stream_(std::move(file), IsKnownClass), archive_(&stream_), options_(options) {}

  bool Next(Observation* observation) {
    while (pending_.empty() && ReadObject()) {
    }
    if (pending_.empty()) return false;
    *observation = std::move(pending_.front());
    pending_.pop_front();
    ++statistics_.scans;
    return true;
  }

  const LogStatistics& statistics() const { return statistics_; }
  double progress() const { return stream_.file().progress(); }

 private:
  using Scan = mrpt::obs::CObservation2DRangeScan;

  bool ReadObject();
  void TakeActions(const mrpt::obs::CActionCollection& actions);
  void TakeFrame(const mrpt::obs::CSensoryFrame& frame);
  void TakeObservation(const mrpt::obs::CObservation& observation);
  void TakeScan(const Scan& from);
  bool IsLaserInUse(const Scan& scan);
  void Malformed(const std::string& problem);
  std::string Where() const;

  RawlogStream stream_;
  Archive archive_;
  LogReaderOptions options_;
  LogStatistics statistics_;
  std::deque<Observation> pending_;
  SE2 T_odom_robot_;
  bool has_actions_ = false;
  double timestamp_ = 0.0;  // of the latest scan that had one
  std::optional<std::pair<std::string, SE2>> laser_;
};

void RawlogReader::Impl::Malformed(const std::string& problem) {
  CountMalformed(Where() + problem, options_, &statistics_);
}

std::string RawlogReader::Impl::Where() const {
  return stream_.file().path() + ": object " + std::to_string(statistics_.lines) + ": ";
}

bool RawlogReader::Impl::ReadObject() {
  mrpt::serialization::CSerializable::Ptr object;
  std::string problem;
  try {
    if (stream_.file().Peek(1).empty()) return false;
    ++statistics_.lines;
    object = archive_.ReadObject();
  } catch (const Error& error) {
    problem = error.what();
  } catch (const std::exception& error) {
    // MRPT adds its own text to the message that the stream threw.
    problem = stream_.failure().empty() ? Where() + FirstMessage(error.what()) : stream_.failure();
  }
  if (!problem.empty()) {
    if (statistics_.lines <= 1) throw Error(ErrorCode::kInput, problem);
    CountMalformed(problem, options_, &statistics_);
    return false;
  }
  if (const auto* actions = dynamic_cast<const mrpt::obs::CActionCollection*>(object.get())) {
    TakeActions(*actions);
  } else if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(object.get())) {
    TakeFrame(*frame);
  } else if (const auto* single = dynamic_cast<const mrpt::obs::CObservation*>(object.get())) {
    TakeObservation(*single);
  } else {
    ++statistics_.ignored;
  }
  return true;
}

void RawlogReader::Impl::TakeActions(const mrpt::obs::CActionCollection& actions) {
  for (const auto& action : actions) {
    using Movement = mrpt::obs::CActionRobotMovement2D;
    const auto* movement = dynamic_cast<const Movement*>(action.get_ptr().get());
    if (movement == nullptr) continue;
    const bool raw = movement->estimationMethod == Movement::emOdometry;
    SE2 step;
    if (raw) {
      step = ToSE2(movement->rawOdometryIncrementReading);
    } else if (movement->poseChange) {
      step = ToSE2(movement->poseChange->getMeanVal());
    }
    const SE2 moved = T_odom_robot_ * step;
    if (!IsPlausible(moved)) {
      Malformed("an odometry increment out of any bounds");
      continue;
    }
    T_odom_robot_ = moved;
    has_actions_ = true;
    ++statistics_.odometry;
  }
}

void RawlogReader::Impl::TakeFrame(const mrpt::obs::CSensoryFrame& frame) {
  for (const bool scans : {false, true}) {  // odometry first, at any place in the frame
    for (const auto& observation : frame) {
      const bool is_scan = dynamic_cast<const Scan*>(observation.get()) != nullptr;
      if (observation && is_scan == scans) TakeObservation(*observation);
    }
  }
}

void RawlogReader::Impl::TakeObservation(const mrpt::obs::CObservation& observation) {
  if (const auto* scan = dynamic_cast<const Scan*>(&observation)) {
    TakeScan(*scan);
    return;
  }
  const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation);
  if (odometry == nullptr || has_actions_) {  // increments and absolute readings do not mix
    ++statistics_.ignored;
  } else if (IsPlausible(ToSE2(odometry->odometry))) {
    T_odom_robot_ = ToSE2(odometry->odometry);
    ++statistics_.odometry;
  } else {
    Malformed("an odometry pose out of any bounds");
  }
}

bool RawlogReader::Impl::IsLaserInUse(const Scan& scan) {
  if (!scan.isPlanarScan(kHorizontal)) return false;
  const SE2 T_robot_laser = PlanarPose(scan.sensorPose);
  if (!laser_) laser_.emplace(scan.sensorLabel, T_robot_laser);
  const auto& [label, pose] = *laser_;
  return scan.sensorLabel == label &&
         T_robot_laser.Boxminus(pose).cwiseAbs().maxCoeff() <= kSamePlace;
}

void RawlogReader::Impl::TakeScan(const Scan& from) {
  Observation observation;
  std::string problem = ConvertRanges(from, &observation.scan);
  if (problem.empty()) problem = ConvertGeometry(from, &observation.scan);
  if (!problem.empty()) {
    Malformed(problem);
    return;
  }
  if (!IsLaserInUse(from)) {
    ++statistics_.ignored;
    return;
  }
  if (from.timestamp != INVALID_TIMESTAMP) timestamp_ = mrpt::Clock::toDouble(from.timestamp);
  observation.timestamp = timestamp_;
  observation.T_odom_robot = T_odom_robot_;
  pending_.push_back(std::move(observation));
}

RawlogReader::RawlogReader(InputFile file, const LogReaderOptions& options)
    : impl_(std::make_unique<Impl>(std::move(file), options)) {}

RawlogReader::~RawlogReader() = default;

bool RawlogReader::Next(Observation* observation) { return impl_->Next(observation); }

const LogStatistics& RawlogReader::statistics() const { return impl_->statistics(); }

double RawlogReader::progress() const { return impl_->progress(); }

}  // namespace loopgrid
