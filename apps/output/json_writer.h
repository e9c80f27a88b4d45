#pragma once

#include <concepts>
#include <cstdint>
#include <ranges>
#include <string>
#include <string_view>

namespace loopgrid {

/// A number with a fixed number of digits after the decimal point.
struct FixedNumber {
  double value;
  int decimals;
};

/// A number with a fixed number of significant digits.
struct RoundedNumber {
  double value;
  int digits;
};

/// Writes JSON text piece by piece; keys keep the order of the calls. Numbers without a format of
/// their own have enough digits to be read back exactly. NaN and infinities, which JSON does not
/// have, become `null`. Bytes that are not UTF-8, as in names of files, become U+FFFD.
///
///     JsonWriter json(JsonWriter::Layout::kOneLine);
///     json.BeginObject().Field("scans", 3).Key("map").BeginObject().Field("width", 20);
///     json.EndObject().EndObject();
///     json.Take();  // {"scans":3,"map":{"width":20}}
class JsonWriter {
 public:
  enum class Layout {
    kOneLine,
    kIndented,  ///< a line for each member, two spaces a level
  };

  explicit JsonWriter(Layout layout) : layout_(layout) {}

  JsonWriter& BeginObject() { return Begin('{'); }
  JsonWriter& EndObject() { return End('}'); }
  JsonWriter& BeginArray() { return Begin('['); }
  JsonWriter& EndArray() { return End(']'); }

  /// The name of the member of an object whose value comes next.
  JsonWriter& Key(std::string_view key);

  // A value: the next element of an array, or what belongs to the last key.

  JsonWriter& Null() { return Raw("null"); }
  JsonWriter& Value(std::same_as<bool> auto value) { return Raw(value ? "true" : "false"); }
  template <std::integral Integer>
  requires(!std::same_as<Integer, bool>) JsonWriter& Value(Integer value) {
    return Whole(static_cast<std::int64_t>(value));
  }
  JsonWriter& Value(double value);
  JsonWriter& Value(FixedNumber number);
  JsonWriter& Value(RoundedNumber number);
  JsonWriter& Value(std::string_view text);
  JsonWriter& Value(const std::string& text) { return Value(std::string_view(text)); }
  JsonWriter& Value(const char* text) { return Value(std::string_view(text)); }

  /// An array of all elements.
  template <std::ranges::input_range Range>
  JsonWriter& Value(const Range& elements) {
    BeginArray();
    for (const auto& element : elements) Value(element);
    return EndArray();
  }

  /// A value that is already JSON text, on one line.
  JsonWriter& Raw(std::string_view json);

  /// A member of an object.
  template <typename Member>
  JsonWriter& Field(std::string_view key, const Member& value) {
    return Key(key).Value(value);
  }

  /// Returns the text so far and empties the writer.
  std::string Take();

 private:
  JsonWriter& Begin(char bracket);
  JsonWriter& End(char bracket);
  JsonWriter& Whole(std::int64_t value);
  void BeginValue();
  void BreakLine();

  Layout layout_;
  std::string text_;
  int depth_ = 0;
  bool is_first_ = true;  // of the innermost object or array
  bool follows_key_ = false;
};

}  // namespace loopgrid
