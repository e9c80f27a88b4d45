// loopgrid-rawlog.so: the reader of rawlogs, with MRPT.
#include <utility>

#include "frontend/log/rawlog/rawlog_reader.h"

extern "C" {

extern const char loopgrid_module_version[];
const char loopgrid_module_version[] = LOOPGRID_VERSION;

/// Takes the file; the caller owns what it returns.
loopgrid::LogReader* loopgrid_open_rawlog(loopgrid::InputFile* file,
                                          const loopgrid::LogReaderOptions* options);
loopgrid::LogReader* loopgrid_open_rawlog(loopgrid::InputFile* file,
                                          const loopgrid::LogReaderOptions* options) {
  return new loopgrid::RawlogReader(std::move(*file), *options);
}
}
