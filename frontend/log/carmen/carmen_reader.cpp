#include "frontend/log/carmen/carmen_reader.h"

#include <string_view>
#include <utility>

namespace loopgrid {

CarmenReader::CarmenReader(LineReader lines, const LogReaderOptions& options)
    : lines_(std::move(lines)), decoder_(lines_.path(), options) {}

bool CarmenReader::Next(Observation* observation) {
  while (!decoder_.Next(observation)) {
    if (ReadLine()) continue;
    decoder_.Finish();
    return decoder_.Next(observation);
  }
  return true;
}

bool CarmenReader::ReadLine() {
  std::string_view line;
  try {
    if (!lines_.Next(&line)) return false;
  } catch (const Error& error) {
    if (statistics().lines == 0) throw;
    decoder_.BreakOff(error.what());
    return false;
  }
  decoder_.AddLine(line, lines_.terminated(), lines_.too_long());
  return true;
}

}  // namespace loopgrid
