#pragma once

#include "backend/base/line_reader.h"
#include "frontend/log/carmen/carmen_decoder.h"
#include "frontend/log/observation/log_reader.h"

namespace loopgrid {

/// Reads CARMEN text logs with a CarmenDecoder. If the file or its gzip data are cut, all scans
/// before the cut are returned.
class CarmenReader : public LogReader {
 public:
  CarmenReader(LineReader lines, const LogReaderOptions& options);

  bool Next(Observation* observation) override;
  const LogStatistics& statistics() const override { return decoder_.statistics(); }
  double progress() const override { return lines_.progress(); }

 private:
  bool ReadLine();

  LineReader lines_;
  CarmenDecoder decoder_;
};

}  // namespace loopgrid
