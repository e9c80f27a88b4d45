#pragma once

#include <memory>

#include "backend/base/input_file.h"
#include "frontend/log/observation/log_reader.h"

namespace loopgrid {

/// A RawlogReader for the file. The library's definition is in open_rawlog.cpp. A program that
/// defines the function itself takes the place of that definition, and does not link MRPT then.
std::unique_ptr<LogReader> OpenRawlog(InputFile file, const LogReaderOptions& options);

}  // namespace loopgrid
