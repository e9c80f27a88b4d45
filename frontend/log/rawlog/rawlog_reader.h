#pragma once

#include <memory>

#include "backend/base/input_file.h"
#include "frontend/log/observation/log_reader.h"

namespace loopgrid {

/// Reads MRPT rawlogs: pairs of action and sensory frame, whose odometry increments are added up
/// from the origin, and plain streams of observations with absolute odometry. Of several lasers the
/// first horizontal one is used, recognised by its label and pose. Readings flagged invalid become
/// the scan's maximum range. The file does not give the length of an object, so the log ends at the
/// first object that cannot be read (cut, corrupt or of an unknown class). It counts as malformed.
class RawlogReader : public LogReader {
 public:
  /// Throws Error (kInput) on the first Next() if not even one object can be read.
  RawlogReader(InputFile file, const LogReaderOptions& options);
  ~RawlogReader() override;

  bool Next(Observation* observation) override;
  const LogStatistics& statistics() const override;
  double progress() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopgrid
