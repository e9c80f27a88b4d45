#include "backend/base/parse_number.h"

#include <algorithm>
#include <array>
#include <bit>

namespace loopgrid {
namespace {

constexpr int kMaxDigits = 15;  // their value is exact in a double, and so is the power of ten

constexpr std::array<double, kMaxDigits + 1> kPowersOfTen = {
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Whether a double lies exactly between two neighbouring floats (of normal size).
bool IsBetweenFloats(double value) {
  constexpr std::uint64_t kDroppedBits = (std::uint64_t{1} << 29) - 1;
  return (std::bit_cast<std::uint64_t>(value) & kDroppedBits) == std::uint64_t{1} << 28;
}

}  // namespace

/// The next field, if it is digits with at most a sign and a point, and few enough of them. Where
/// it is not, the position stays.
/// Clinger's fast path ("How to read floating point numbers accurately", 1990): digits and power of
/// ten are exact, so one division rounds correctly.
bool FieldCursor::NextShortDecimal(double* value) {
  SkipBlanks();
  const char* p = position_;
  const bool is_negative = p != end_ && *p == '-';
  if (is_negative) ++p;
  const char* first = p;
  std::uint64_t digits = 0;
  for (; p != end_ && IsDigit(*p); ++p) digits = digits * 10 + static_cast<unsigned>(*p - '0');
  std::ptrdiff_t digit_count = p - first;
  std::ptrdiff_t decimals = 0;
  if (p != end_ && *p == '.') {
    const char* point = p++;
    for (; p != end_ && IsDigit(*p); ++p) digits = digits * 10 + static_cast<unsigned>(*p - '0');
    decimals = p - point - 1;
    digit_count += decimals;
  }
  const bool is_whole_field = p == end_ || IsBlank(*p);
  if (!is_whole_field || digit_count < 1 || digit_count > kMaxDigits) return false;
  position_ = p;
  const double magnitude =
      static_cast<double>(digits) / kPowersOfTen[static_cast<std::size_t>(decimals)];
  *value = is_negative ? -magnitude : magnitude;
  return true;
}

bool FieldCursor::NextDecimal(double* value) { return NextShortDecimal(value) || Next(value); }

// Rounding to float after rounding to double is right unless the double fell between two floats,
// where the side it came from is lost.
bool FieldCursor::NextDecimal(float* value) {
  const char* before = position_;
  double parsed = 0.0;
  if (NextShortDecimal(&parsed) && !IsBetweenFloats(parsed)) {
    *value = static_cast<float>(parsed);
    return true;
  }
  position_ = before;
  return Next(value);
}

std::string Quoted(std::string_view field) {
  constexpr std::size_t kLongest = 40;
  std::string text(field.substr(0, kLongest));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + text + "'";
}

}  // namespace loopgrid
