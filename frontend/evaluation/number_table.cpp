#include "frontend/evaluation/number_table.h"

#include <fmt/format.h>

#include <string_view>

#include "backend/base/line_reader.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

NumberTable::Row ParseRow(FieldCursor fields, const LineReader& lines) {
  NumberTable::Row row{.line_number = lines.line_number()};
  constexpr std::size_t kColumns = NumberTable::kColumns;
  for (std::size_t i = 0; i < kColumns; ++i) {
    if (fields.AtEnd()) {
      throw lines.ErrorHere(fmt::format("expected {} numbers, found {}", kColumns, i));
    }
    if (!fields.Next(&row.numbers[i])) {
      throw lines.ErrorHere(fmt::format("field {} is not a finite number", i + 1));
    }
  }
  if (!fields.AtEnd()) {
    throw lines.ErrorHere(fmt::format("expected {} numbers, found more", kColumns));
  }
  return row;
}

}  // namespace

Error NumberTable::ErrorAt(const Row& row, const std::string& problem) const {
  return Error(ErrorCode::kInput, fmt::format("{}:{}: {}", path, row.line_number, problem));
}

NumberTable ReadNumberTable(const std::string& path) {
  NumberTable table{.path = path};
  LineReader lines(path);
  std::string_view line;
  while (lines.Next(&line)) {
    if (lines.too_long()) throw lines.ErrorHere("the line is too long");
    FieldCursor fields(line);
    if (fields.AtEnd() || line[fields.offset()] == '#') continue;
    table.rows.push_back(ParseRow(fields, lines));
  }
  return table;
}

}  // namespace loopgrid
