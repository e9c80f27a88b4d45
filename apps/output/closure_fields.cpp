#include "apps/output/closure_fields.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <variant>

namespace loopgrid {
namespace {

/// How a number is written.
struct Format {
  enum { kFixed, kRounded } kind = kFixed;
  int digits = 0;  ///< after the decimal point, or significant ones
};

constexpr Format Fixed(int decimals) { return {Format::kFixed, decimals}; }
constexpr Format Rounded(int digits) { return {Format::kRounded, digits}; }

using FieldValue = std::variant<std::int64_t, double, std::string_view>;

struct Field {
  std::string_view name;
  FieldValue (*value)(const Closure& closure);
  Format format = {};   // of a double
  Format on_page = {};  // of a double on the page
};

template <int kRow, int kColumn>
FieldValue Covariance(const Closure& closure) {
  return closure.covariance(kRow, kColumn);
}

constexpr std::array<Field, 20> kFields = {{
    {"from", [](const Closure& c) -> FieldValue { return std::int64_t{c.from}; }},
    {"to", [](const Closure& c) -> FieldValue { return std::int64_t{c.to}; }},
    {"time", [](const Closure& c) -> FieldValue { return c.timestamp; }, Fixed(6), Fixed(3)},
    {"distance_sigmas", [](const Closure& c) -> FieldValue { return c.distance_sigmas; }, Fixed(3),
     Fixed(2)},
    {"score", [](const Closure& c) -> FieldValue { return c.score; }, Fixed(4), Fixed(3)},
    {"second_score", [](const Closure& c) -> FieldValue { return c.second_score; }, Fixed(4)},
    {"denied_share", [](const Closure& c) -> FieldValue { return c.denied_share; }, Fixed(3)},
    {"x", [](const Closure& c) -> FieldValue { return c.T_from_to.x(); }, Fixed(4)},
    {"y", [](const Closure& c) -> FieldValue { return c.T_from_to.y(); }, Fixed(4)},
    {"theta", [](const Closure& c) -> FieldValue { return c.T_from_to.theta(); }, Fixed(5)},
    {"distance", [](const Closure& c) -> FieldValue { return c.T_from_to.translation().norm(); },
     Fixed(4), Fixed(2)},
    {"cov_xx", Covariance<0, 0>, Rounded(4)},
    {"cov_xy", Covariance<0, 1>, Rounded(4)},
    {"cov_xt", Covariance<0, 2>, Rounded(4)},
    {"cov_yy", Covariance<1, 1>, Rounded(4)},
    {"cov_yt", Covariance<1, 2>, Rounded(4)},
    {"cov_tt", Covariance<2, 2>, Rounded(4)},
    {"chi2", [](const Closure& c) -> FieldValue { return c.chi2; }, Rounded(4)},
    {"outcome", [](const Closure& c) -> FieldValue { return ToString(c.outcome); }},
    {"reason", [](const Closure& c) -> FieldValue { return Explain(c.outcome); }},
}};

// The fields of each output, in order.
constexpr auto kCsvColumns = std::to_array<std::string_view>(
    {"from", "to", "time", "distance_sigmas", "score", "second_score", "denied_share", "x", "y",
     "theta", "cov_xx", "cov_xy", "cov_xt", "cov_yy", "cov_yt", "cov_tt", "chi2", "outcome"});
constexpr auto kEventMembers =
    std::to_array<std::string_view>({"from", "to", "outcome", "score", "chi2", "reason"});
constexpr auto kPageMembers = std::to_array<std::string_view>(
    {"from", "to", "time", "outcome", "reason", "score", "distance", "distance_sigmas"});

/// The fields of these names. A name that is not in the table does not compile.
template <std::size_t kCount>
consteval std::array<const Field*, kCount> Select(
    const std::array<std::string_view, kCount>& names) {
  std::array<const Field*, kCount> selected{};
  for (std::size_t i = 0; i < kCount; ++i) {
    for (const Field& field : kFields) {
      if (field.name == names[i]) selected[i] = &field;
    }
    if (selected[i] == nullptr) throw "there is no such field";
  }
  return selected;
}

constexpr auto kCsvFields = Select(kCsvColumns);
constexpr auto kEventFields = Select(kEventMembers);
constexpr auto kPageFields = Select(kPageMembers);

void AppendCsv(const Field& field, const Closure& closure, std::string* text) {
  const FieldValue value = field.value(closure);
  const auto out = std::back_inserter(*text);
  if (const double* number = std::get_if<double>(&value)) {
    const bool is_fixed = field.format.kind == Format::kFixed;
    fmt::format_to(out, fmt::runtime(is_fixed ? "{:.{}f}" : "{:.{}g}"), *number,
                   field.format.digits);
  } else {
    std::visit([out](const auto& other) { fmt::format_to(out, "{}", other); }, value);
  }
}

void AddMember(const Field& field, const Format& format, const Closure& closure, JsonWriter* json) {
  const FieldValue value = field.value(closure);
  json->Key(field.name);
  if (const double* number = std::get_if<double>(&value)) {
    if (format.kind == Format::kFixed) {
      json->Value(FixedNumber{*number, format.digits});
    } else {
      json->Value(RoundedNumber{*number, format.digits});
    }
  } else {
    std::visit([json](const auto& other) { json->Value(other); }, value);
  }
}

}  // namespace

std::string ClosureCsvHeader() {
  std::string text;
  for (const Field* field : kCsvFields) {
    if (!text.empty()) text += ',';
    text += field->name;
  }
  return text;
}

std::string ClosureCsvLine(const Closure& closure) {
  std::string text;
  for (const Field* field : kCsvFields) {
    if (!text.empty()) text += ',';
    AppendCsv(*field, closure, &text);
  }
  return text;
}

void AddClosureEventFields(const Closure& closure, JsonWriter* json) {
  for (const Field* field : kEventFields) AddMember(*field, field->format, closure, json);
}

void AddClosurePageFields(const Closure& closure, JsonWriter* json) {
  for (const Field* field : kPageFields) AddMember(*field, field->on_page, closure, json);
}

}  // namespace loopgrid
