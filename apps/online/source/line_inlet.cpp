#include "apps/online/source/line_inlet.h"

#include <chrono>
#include <utility>

namespace loopgrid {

bool LineInlet::Add(std::string_view bytes) {
  const auto now = std::chrono::steady_clock::now();
  completed_line_ = false;
  ReceivedLine line;
  while (splitter_.Next(&bytes, &line)) {
    completed_line_ = true;
    line.arrival = now;
    if (!queue_->Push(std::move(line))) return false;
  }
  return true;
}

bool LineInlet::Finish() {
  ReceivedLine line;
  if (!splitter_.Finish(&line)) return true;
  line.arrival = std::chrono::steady_clock::now();
  return queue_->Push(std::move(line));
}

}  // namespace loopgrid
