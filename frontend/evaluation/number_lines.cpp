#include "frontend/evaluation/number_lines.h"

#include <string>

#include "backend/base/parse_number.h"

namespace loopgrid {

bool NextNumberLine(LineReader* lines, std::span<double> numbers) {
  std::string_view line;
  while (lines->Next(&line)) {
    if (lines->too_long()) throw lines->ErrorHere("the line is too long");
    FieldCursor fields(line);
    if (fields.AtEnd() || line[fields.offset()] == '#') continue;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (fields.AtEnd()) {
        throw lines->ErrorHere("expected " + std::to_string(numbers.size()) + " numbers, found " +
                               std::to_string(i));
      }
      if (!fields.Next(&numbers[i])) {
        throw lines->ErrorHere("field " + std::to_string(i + 1) + " is not a finite number");
      }
    }
    if (!fields.AtEnd()) {
      throw lines->ErrorHere("expected " + std::to_string(numbers.size()) + " numbers, found more");
    }
    return true;
  }
  return false;
}

}  // namespace loopgrid
