#include "apps/output/json_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace loopgrid {
namespace {

using Json = nlohmann::json;

std::string TextOf(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

JsonWriter& JsonWriter::Key(std::string_view key) {
  BeginValue();
  text_ += TextOf(key);
  text_ += layout_ == Layout::kOneLine ? ":" : ": ";
  follows_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::Value(double value) { return Raw(TextOf(value)); }

JsonWriter& JsonWriter::Value(FixedNumber number) {
  if (!std::isfinite(number.value)) return Null();
  BeginValue();
  fmt::format_to(std::back_inserter(text_), "{:.{}f}", number.value, number.decimals);
  return *this;
}

JsonWriter& JsonWriter::Value(RoundedNumber number) {
  if (!std::isfinite(number.value)) return Null();
  BeginValue();
  fmt::format_to(std::back_inserter(text_), "{:.{}g}", number.value, number.digits);
  return *this;
}

JsonWriter& JsonWriter::Value(std::string_view text) { return Raw(TextOf(text)); }

JsonWriter& JsonWriter::Raw(std::string_view json) {
  BeginValue();
  text_ += json;
  return *this;
}

std::string JsonWriter::Take() {
  std::string text = std::move(text_);
  *this = JsonWriter(layout_);
  return text;
}

JsonWriter& JsonWriter::Whole(std::int64_t value) {
  BeginValue();
  fmt::format_to(std::back_inserter(text_), "{}", value);
  return *this;
}

JsonWriter& JsonWriter::Begin(char bracket) {
  BeginValue();
  text_ += bracket;
  ++depth_;
  is_first_ = true;
  return *this;
}

JsonWriter& JsonWriter::End(char bracket) {
  --depth_;
  if (!is_first_) BreakLine();
  text_ += bracket;
  is_first_ = false;
  return *this;
}

/// Writes what separates the next value from the one before: a comma and, if indented, a line
/// break.
void JsonWriter::BeginValue() {
  if (std::exchange(follows_key_, false)) return;
  if (!is_first_) text_ += ',';
  if (depth_ > 0) BreakLine();
  is_first_ = false;
}

void JsonWriter::BreakLine() {
  if (layout_ == Layout::kOneLine) return;
  text_ += '\n';
  text_.append(2 * static_cast<std::size_t>(depth_), ' ');
}

}  // namespace loopgrid
