// This file must define nothing else. The linker takes a file from a library only if it needs a
// symbol of it. So a program that defines its own OpenRawlog() does not link this one.
#include "frontend/log/rawlog/open_rawlog.h"

#include <memory>
#include <utility>

#include "frontend/log/rawlog/rawlog_reader.h"

namespace loopgrid {

std::unique_ptr<LogReader> OpenRawlog(InputFile file, const LogReaderOptions& options) {
  return std::make_unique<RawlogReader>(std::move(file), options);
}

}  // namespace loopgrid
