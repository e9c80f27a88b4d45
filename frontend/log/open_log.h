#pragma once

#include <memory>
#include <string>

#include "frontend/log/observation/log_reader.h"

namespace loopgrid {

/// Opens a log of any known kind: CARMEN text or MRPT rawlog, plain or gzipped. The content tells
/// which. Throws Error (kInput) for a missing, unreadable or empty file, or a directory.
std::unique_ptr<LogReader> OpenLog(const std::string& path, const LogReaderOptions& options = {});

}  // namespace loopgrid
