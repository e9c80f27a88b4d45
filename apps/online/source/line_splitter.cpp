#include "apps/online/source/line_splitter.h"

#include <utility>

namespace loopgrid {

bool LineSplitter::Next(std::string_view* bytes, ReceivedLine* line) {
  const std::size_t end = bytes->find('\n');
  Take(bytes->substr(0, end));
  if (end == bytes->npos) {
    *bytes = {};
    return false;
  }
  bytes->remove_prefix(end + 1);
  MakeLine(true, line);
  return true;
}

bool LineSplitter::Finish(ReceivedLine* line) {
  const bool has_rest = skipping_ || !begun_.empty();
  if (has_rest) MakeLine(false, line);
  at_start_ = true;
  return has_rest;
}

void LineSplitter::Take(std::string_view bytes) {
  // One byte more than the longest line is allowed, because it may be a CR.
  if (begun_.size() + bytes.size() > max_line_length_ + 1) skipping_ = true;
  if (skipping_) {
    begun_ = {};
  } else {
    begun_ += bytes;
  }
}

void LineSplitter::MakeLine(bool terminated, ReceivedLine* line) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (begun_.ends_with('\r')) begun_.pop_back();
  line->too_long = skipping_ || begun_.size() > max_line_length_;
  line->terminated = terminated;
  if (line->too_long) begun_.clear();
  if (at_start_ && begun_.starts_with(kByteOrderMark)) begun_.erase(0, kByteOrderMark.size());
  line->text = std::exchange(begun_, {});
  skipping_ = false;
  at_start_ = false;
}

}  // namespace loopgrid
