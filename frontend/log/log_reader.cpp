#include "frontend/log/log_reader.h"

#include <utility>

#include "backend/base/error.h"
#include "frontend/log/carmen/carmen_reader.h"
#include "frontend/log/rawlog/rawlog_reader.h"

namespace loopgrid {

void CountMalformed(const std::string& problem, const LogReaderOptions& options,
                    LogStatistics* statistics) {
  if (options.strict) throw Error(ErrorCode::kInput, problem);
  ++statistics->malformed;
  if (static_cast<int>(statistics->first_problems.size()) < options.max_reported_problems) {
    statistics->first_problems.push_back(problem);
  }
}

std::unique_ptr<LogReader> OpenLog(const std::string& path, const LogReaderOptions& options) {
  InputFile file(path);
  const std::string_view start = file.Peek(4096);
  if (start.empty()) throw Error(ErrorCode::kInput, path + ": is empty");
  if (LooksLikeRawlog(start)) return std::make_unique<RawlogReader>(std::move(file), options);
  if (start.find('\0') != start.npos) {
    throw Error(ErrorCode::kInput, path + ": is neither a CARMEN log nor an MRPT rawlog");
  }
  return std::make_unique<CarmenReader>(LineReader(std::move(file)), options);
}

}  // namespace loopgrid
