#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace loopgrid {

/// Reads the whole of `text` as a number; the locale does not matter. Returns false and leaves
/// `value` unchanged if the text is anything else: empty, a number with characters after it, NaN,
/// an infinity, or a number out of range.
template <typename Number>
bool ParseNumber(std::string_view text, Number* value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number parsed{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, parsed);
  if (error != std::errc() || stop != end) return false;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(parsed)) return false;
  }
  *value = parsed;
  return true;
}

/// A field in quotes, for a message: a long field is cut, and '?' replaces unprintable bytes.
std::string Quoted(std::string_view field);

/// Reads a line field by field. Spaces and tabs separate fields.
class FieldCursor {
 public:
  explicit FieldCursor(std::string_view line)
      : begin_(line.data()), position_(begin_), end_(begin_ + line.size()) {}

  /// The next field, empty at the end of the line.
  std::string_view Next() {
    SkipBlanks();
    const char* start = position_;
    while (position_ != end_ && !IsBlank(*position_)) ++position_;
    return {start, static_cast<std::size_t>(position_ - start)};
  }

  /// The next field as a number (see ParseNumber).
  template <typename Number>
  bool Next(Number* value) {
    return ParseNumber(Next(), value);
  }

  /// The same results as Next(value), but faster for the short decimal numbers in logs and graphs.
  bool NextDecimal(float* value);
  bool NextDecimal(double* value);

  /// Whether only blanks are left.
  bool AtEnd() {
    SkipBlanks();
    return position_ == end_;
  }

  /// How many bytes of the line have been read.
  std::size_t offset() const { return static_cast<std::size_t>(position_ - begin_); }

  void SkipBlanks() {
    while (position_ != end_ && IsBlank(*position_)) ++position_;
  }

 private:
  bool NextShortDecimal(double* value);

  static bool IsBlank(char c) { return c == ' ' || c == '\t'; }

  const char* begin_;
  const char* position_;
  const char* end_;
};

}  // namespace loopgrid
