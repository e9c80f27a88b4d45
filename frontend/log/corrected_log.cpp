#include "frontend/log/corrected_log.h"

#include <fmt/format.h>

#include <memory>
#include <string_view>
#include <utility>

#include "backend/base/atomic_file.h"
#include "backend/base/line_reader.h"
#include "frontend/log/carmen/carmen_format.h"
#include "frontend/log/carmen/carmen_interpreter.h"
#include "frontend/log/observation/log_reader.h"
#include "frontend/log/rawlog/open_rawlog.h"
#include "frontend/log/rawlog/rawlog_format.h"

namespace loopgrid {
namespace {

/// The corrected poses, one for each scan in turn.
class CorrectedScans {
 public:
  CorrectedScans(std::string path, std::span<const CorrectedScan> scans)
      : path_(std::move(path)), scans_(scans) {}

  const CorrectedScan& Next() {
    if (next_ == scans_.size()) Mismatch();
    return scans_[next_++];
  }
  void RequireAtEnd() const {
    if (next_ != scans_.size()) Mismatch();
  }

 private:
  [[noreturn]] void Mismatch() const {
    throw Error(ErrorCode::kInput, fmt::format("{}: does not hold the {} scans that were corrected",
                                               path_, scans_.size()));
  }

  std::string path_;
  std::span<const CorrectedScan> scans_;
  std::size_t next_ = 0;
};

/// Writes the messages of one log.
class CorrectedLogWriter {
 public:
  CorrectedLogWriter(AtomicFile* output, CorrectedScans* scans) : output_(output), scans_(scans) {}

  CorrectedLogStatistics FromRawlog(InputFile input);
  CorrectedLogStatistics FromCarmen(LineReader lines);

 private:
  bool NextLine(LineReader* lines, std::string_view* line);
  void WriteScan(std::string_view line);
  void WriteOtherLaser(std::string_view line);
  void WriteWithPose(std::string_view line, const SE2& T_map_laser);
  void StateMount(CarmenTag tag, const SE2& T_robot_laser);
  void Write(std::string_view text);

  AtomicFile* output_;
  CorrectedScans* scans_;
  CarmenInterpreter interpreter_;
  CorrectedLogStatistics statistics_;
  bool had_scan_ = false;
  double start_ = 0.0;  // time of the first scan, seconds
  SE2 T_map_odom_;      // the correction of the latest scan
};

void CorrectedLogWriter::Write(std::string_view text) {
  output_->Append(text);
  for (const char c : text) statistics_.lines += c == '\n' ? 1 : 0;
}

CorrectedLogStatistics CorrectedLogWriter::FromRawlog(InputFile input) {
  const std::unique_ptr<LogReader> reader = OpenRawlog(std::move(input), {});
  Observation observation;
  while (reader->Next(&observation)) {
    const auto& [T_map_robot, T_robot_laser] = scans_->Next();
    if (!had_scan_) {
      start_ = observation.timestamp;
      Write(CarmenMountLines(true, T_robot_laser));
    }
    had_scan_ = true;
    Write(CarmenRobotLaserLine(true, observation, T_map_robot * T_robot_laser,
                               observation.timestamp - start_));
  }
  statistics_.left_out = reader->statistics().malformed;
  return statistics_;
}

CorrectedLogStatistics CorrectedLogWriter::FromCarmen(LineReader lines) {
  std::string_view line;
  while (NextLine(&lines, &line)) {
    switch (interpreter_.Read(line, lines.terminated())) {
      case CarmenMeaning::kScan:
        WriteScan(line);
        break;
      case CarmenMeaning::kOtherLaser:
        WriteOtherLaser(line);
        break;
      case CarmenMeaning::kMalformed:
        ++statistics_.left_out;
        break;
      default:
        Write(line);
        Write("\n");
    }
  }
  return statistics_;
}

/// The next line that is not too long. A damaged file ends where the damage begins, as for the
/// reader.
bool CorrectedLogWriter::NextLine(LineReader* lines, std::string_view* line) {
  try {
    while (lines->Next(line)) {
      if (!lines->too_long()) return true;
      ++statistics_.left_out;
    }
  } catch (const Error&) {
    if (lines->line_number() == 0) throw;
    ++statistics_.left_out;
  }
  return false;
}

void CorrectedLogWriter::WriteScan(std::string_view line) {
  const CarmenLaserMessage& message = interpreter_.message();
  const Observation observation = interpreter_.MakeObservation();
  const auto& [T_map_robot, T_robot_laser] = scans_->Next();
  if (!had_scan_) {
    start_ = message.timestamp;
    StateMount(message.tag, T_robot_laser);
  }
  had_scan_ = true;
  T_map_odom_ = T_map_robot * observation.T_odom_robot.Inverse();
  const SE2 T_map_laser = T_map_robot * T_robot_laser;
  if (message.has_poses) {
    WriteWithPose(line, T_map_laser);
  } else {
    Write(CarmenRobotLaserLine(!IsRearLaser(message.tag), observation, T_map_laser,
                               message.timestamp - start_));
  }
}

void CorrectedLogWriter::StateMount(CarmenTag tag, const SE2& T_robot_laser) {
  const bool front = !IsRearLaser(tag);
  const SE2 known = interpreter_.parameters()
                        .Of(front ? CarmenTag::kRobotLaser1 : CarmenTag::kRobotLaser2)
                        .T_robot_laser();
  const bool stated = T_robot_laser.Boxminus(known).cwiseAbs().maxCoeff() < 1e-6;
  if (!stated) Write(CarmenMountLines(front, T_robot_laser));
}

void CorrectedLogWriter::WriteOtherLaser(std::string_view line) {
  const CarmenLaserMessage& message = interpreter_.message();
  if (message.has_poses && had_scan_) {
    WriteWithPose(line, T_map_odom_ * message.T_odom_laser);
  } else {
    Write(line);
    Write("\n");
  }
}

void CorrectedLogWriter::WriteWithPose(std::string_view line, const SE2& T_map_laser) {
  const CarmenLaserMessage& message = interpreter_.message();
  Write(line.substr(0, message.laser_pose_begin));
  Write(CarmenPose(T_map_laser));
  Write(line.substr(message.laser_pose_end));
  Write("\n");
}

}  // namespace

CorrectedLogStatistics WriteCorrectedLog(const std::string& input, const std::string& output,
                                         std::span<const CorrectedScan> scans) {
  InputFile file(input);
  CorrectedScans corrected(input, scans);
  AtomicFile target(output);
  CorrectedLogWriter writer(&target, &corrected);
  const CorrectedLogStatistics statistics = LooksLikeRawlog(file.Peek(256))
                                                ? writer.FromRawlog(std::move(file))
                                                : writer.FromCarmen(LineReader(std::move(file)));
  corrected.RequireAtEnd();
  target.Commit();
  return statistics;
}

}  // namespace loopgrid
