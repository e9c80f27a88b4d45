#pragma once

#include <memory>

#include "backend/base/input_file.h"
#include "frontend/log/observation/log_reader.h"

namespace loopgrid {

/// A RawlogReader for the file. The library defines this function in open_rawlog.cpp. A program may
/// define the function itself. Its definition is then used, and MRPT is not linked.
std::unique_ptr<LogReader> OpenRawlog(InputFile file, const LogReaderOptions& options);

}  // namespace loopgrid
