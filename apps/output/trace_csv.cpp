#include "apps/output/trace_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string_view>

#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

constexpr std::string_view kIteration = "iteration";
constexpr std::string_view kError = "F";

std::vector<std::string_view> SplitAtCommas(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    const std::size_t first = std::min(field.find_first_not_of(" \t"), field.size());
    field.remove_prefix(first);
    field = field.substr(0, field.find_last_not_of(" \t") + 1);
    fields.push_back(field);
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::size_t ColumnOf(std::string_view name, const std::vector<std::string_view>& header,
                     const LineReader& lines) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found != header.end()) return static_cast<std::size_t>(found - header.begin());
  throw lines.ErrorHere(fmt::format(
      "no column '{}' in the header, expected a trace as loopgrid optimize --trace writes it",
      name));
}

double ParseField(std::string_view field, std::string_view name, const LineReader& lines) {
  double value = 0.0;
  if (ParseNumber(field, &value)) return value;
  if (name == kError) {
    if (field == "inf") return std::numeric_limits<double>::infinity();
    if (field == "nan" || field == "-nan") return std::numeric_limits<double>::quiet_NaN();
  }
  throw lines.ErrorHere(
      fmt::format("{} is not a number, expected one for '{}'", Quoted(field), name));
}

}  // namespace

std::string FormatTraceCsv(const std::vector<IterationRecord>& trace) {
  std::string text = "iteration,F,chi2,damping,step,seconds\n";
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const IterationRecord& record = trace[i];
    fmt::format_to(std::back_inserter(text), "{},{:.15g},{:.15g},{:.6g},{:.6g},{:.6f}\n", i,
                   record.error, record.chi2, record.damping, record.step, record.seconds);
  }
  return text;
}

std::vector<Eigen::Vector2d> ReadTraceCsv(const std::string& path) {
  LineReader lines(path);
  std::string_view line;
  if (!lines.Next(&line)) throw Error(ErrorCode::kInput, path + ": the file is empty");
  const std::vector<std::string_view> header = SplitAtCommas(line);
  const std::size_t columns = header.size();
  const std::size_t iteration = ColumnOf(kIteration, header, lines);
  const std::size_t error = ColumnOf(kError, header, lines);
  std::vector<Eigen::Vector2d> points;
  while (lines.Next(&line)) {
    if (line.empty() && !lines.too_long()) continue;
    const std::vector<std::string_view> fields = SplitAtCommas(line);
    if (fields.size() != columns) {
      throw lines.ErrorHere(
          fmt::format("{} fields, expected {} as in the header", fields.size(), columns));
    }
    points.emplace_back(ParseField(fields[iteration], kIteration, lines),
                        ParseField(fields[error], kError, lines));
  }
  if (points.empty()) throw Error(ErrorCode::kInput, path + ": a header, but no iteration in it");
  return points;
}

}  // namespace loopgrid
