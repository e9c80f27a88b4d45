// The program's OpenRawlog(): MRPT is loaded when a rawlog is opened.
#include <memory>
#include <stdexcept>
#include <utility>

#include "apps/modules/module.h"
#include "backend/base/error.h"
#include "frontend/log/rawlog/open_rawlog.h"

namespace loopgrid {

std::unique_ptr<LogReader> OpenRawlog(InputFile file, const LogReaderOptions& options) {
  using OpenFunction = LogReader* (*)(InputFile*, const LogReaderOptions*);
  void* function = nullptr;
  try {
    function = LoadFromModule("loopgrid-rawlog.so", "loopgrid_open_rawlog", "reads MRPT rawlogs");
  } catch (const std::runtime_error& error) {
    throw Error(ErrorCode::kInput, file.path() + ": " + error.what());
  }
  return std::unique_ptr<LogReader>(reinterpret_cast<OpenFunction>(function)(&file, &options));
}

}  // namespace loopgrid
