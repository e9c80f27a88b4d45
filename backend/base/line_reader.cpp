#include "backend/base/line_reader.h"

#include <cstring>
#include <utility>

namespace loopgrid {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;

}  // namespace

LineReader::LineReader(InputFile file, std::size_t max_line_length)
    : file_(std::move(file)),
      max_line_length_(max_line_length),
      // A longest line with its CR and LF, and room to read on.
      buffer_(std::make_unique_for_overwrite<char[]>(max_line_length + 2 + kChunk)) {}

bool LineReader::Refill() {
  if (begin_ > 0) {
    std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = file_.Read(buffer_.get() + end_, kChunk);
  end_ += count;
  return count > 0;
}

bool LineReader::Next(std::string_view* line) {
  too_long_ = false;
  std::size_t searched = 0;  // bytes of the line known to hold no line end
  const char* newline = nullptr;
  while ((newline = FindLineEnd(searched)) == nullptr) {
    searched = end_ - begin_;
    if (searched > max_line_length_ + 1) {  // + 1: the last byte may be a CR
      too_long_ = true;
      begin_ = end_;
      searched = 0;
    }
    if (!Refill()) break;
  }
  terminated_ = newline != nullptr;
  if (!terminated_ && begin_ == end_ && !too_long_) return false;
  ++line_number_;
  const char* begin = buffer_.get() + begin_;
  const std::size_t length =
      terminated_ ? static_cast<std::size_t>(newline - begin) : end_ - begin_;
  begin_ += length + (terminated_ ? 1 : 0);
  *line = std::string_view(begin, length);
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  if (line->size() > max_line_length_) too_long_ = true;
  if (too_long_) *line = {};
  SkipByteOrderMark(line);
  return true;
}

const char* LineReader::FindLineEnd(std::size_t searched) const {
  const char* from = buffer_.get() + begin_ + searched;
  return static_cast<const char*>(std::memchr(from, '\n', end_ - begin_ - searched));
}

void LineReader::SkipByteOrderMark(std::string_view* line) const {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (line_number_ == 1 && line->substr(0, kMark.size()) == kMark) {
    line->remove_prefix(kMark.size());
  }
}

std::string LineReader::Where() const { return path() + ":" + std::to_string(line_number_) + ": "; }

Error LineReader::ErrorHere(const std::string& problem) const {
  return Error(ErrorCode::kInput, Where() + problem);
}

}  // namespace loopgrid
