// This file defines nothing else: the linker takes it only where the program defines no
// OpenRawlog() of its own.
#include "frontend/log/rawlog/open_rawlog.h"

#include <memory>
#include <utility>

#include "frontend/log/rawlog/rawlog_reader.h"

namespace loopgrid {

std::unique_ptr<LogReader> OpenRawlog(InputFile file, const LogReaderOptions& options) {
  return std::make_unique<RawlogReader>(std::move(file), options);
}

}  // namespace loopgrid
