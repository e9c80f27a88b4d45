#include "apps/online/source/start_check.h"

#include "backend/base/error.h"

namespace loopgrid {

void StartCheck::Look(std::string_view bytes) {
  constexpr std::size_t kStart = 4096;  // as far as OpenLog() looks into a file
  constexpr std::string_view kGzip = "\x1F\x8B";
  for (const char c : bytes.substr(0, kStart - seen_)) {
    if (seen_ == 0) maybe_gzip_ = c == kGzip[0];
    if (seen_ == 1 && maybe_gzip_ && c == kGzip[1]) {
      throw Error(ErrorCode::kInput, name_ + ": is gzipped: unpack it on the way (gzip -dc)");
    }
    if (c == '\0') {
      throw Error(ErrorCode::kInput, name_ + ": is binary; a CARMEN log is lines of text");
    }
    ++seen_;
  }
}

}  // namespace loopgrid
