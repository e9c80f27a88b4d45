#include "frontend/log/observation/log_reader.h"

#include "backend/base/error.h"

namespace loopgrid {

void CountMalformed(const std::string& problem, const LogReaderOptions& options,
                    LogStatistics* statistics) {
  if (options.strict) throw Error(ErrorCode::kInput, problem);
  ++statistics->malformed;
  if (static_cast<int>(statistics->first_problems.size()) < options.max_reported_problems) {
    statistics->first_problems.push_back(problem);
  }
}

}  // namespace loopgrid
