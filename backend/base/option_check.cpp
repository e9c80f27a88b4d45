#include "backend/base/option_check.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

// The shortest text that reads back as the same number.
std::string Text(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

void RequireBetween(const char* field, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  throw Error(ErrorCode::kUsage, std::string(field) + " is " + Text(value) + ", expected " +
                                     Text(low) + " to " + Text(high));
}

}  // namespace loopgrid
