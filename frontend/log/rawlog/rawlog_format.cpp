#include "frontend/log/rawlog/rawlog_format.h"

namespace loopgrid {

bool IsMrptClassName(std::string_view text) {
  if (text == "nullptr") return true;
  const bool begins_well = text.substr(0, 6) == "mrpt::" || text.substr(0, 1) == "C";
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_:<>,";
  return text.size() > 3 && begins_well && text.find_first_not_of(kAllowed) == text.npos;
}

// An object begins with the length of its class name and the name, with or without a namespace. The
// length is a byte with the highest bit set, or in old files a number of 32 bits.
bool LooksLikeRawlog(std::string_view start) {
  if (start.size() < 8) return false;
  const auto first = static_cast<unsigned char>(start[0]);
  std::string_view name = start.substr(1);
  if (first < 0x80) {
    if (start.substr(1, 3) != std::string_view("\0\0\0", 3)) return false;
    name = start.substr(4);
  }
  return IsMrptClassName(name.substr(0, first & 0x7FU));
}

}  // namespace loopgrid
