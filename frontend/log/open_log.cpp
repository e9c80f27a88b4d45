#include "frontend/log/open_log.h"

#include <string_view>
#include <utility>

#include "backend/base/error.h"
#include "backend/base/input_file.h"
#include "backend/base/line_reader.h"
#include "frontend/log/carmen/carmen_reader.h"
#include "frontend/log/rawlog/open_rawlog.h"
#include "frontend/log/rawlog/rawlog_format.h"

namespace loopgrid {

std::unique_ptr<LogReader> OpenLog(const std::string& path, const LogReaderOptions& options) {
  InputFile file(path);
  const std::string_view start = file.Peek(4096);
  if (start.empty()) throw Error(ErrorCode::kInput, path + ": is empty");
  if (LooksLikeRawlog(start)) return OpenRawlog(std::move(file), options);
  if (start.find('\0') != start.npos) {
    throw Error(ErrorCode::kInput, path + ": is neither a CARMEN log nor an MRPT rawlog");
  }
  return std::make_unique<CarmenReader>(LineReader(std::move(file)), options);
}

}  // namespace loopgrid
