#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "frontend/log/open_log.h"
#include "tests/support/memory_file.h"

namespace loopgrid::test_support {

struct WholeLog {
  std::vector<Observation> observations;
  LogStatistics statistics;
};

/// Everything that OpenLog() reads from a file.
inline WholeLog ReadWholeLog(const std::string& path, const LogReaderOptions& options = {}) {
  WholeLog log;
  const auto reader = OpenLog(path, options);
  Observation observation;
  while (reader->Next(&observation)) log.observations.push_back(observation);
  log.statistics = reader->statistics();
  return log;
}

/// The same for bytes.
inline WholeLog ReadWholeLogFrom(std::string_view content, const LogReaderOptions& options = {}) {
  const MemoryFile file(content);
  return ReadWholeLog(file.path(), options);
}

}  // namespace loopgrid::test_support
