#include "apps/output/closures_csv.h"

#include "apps/output/closure_fields.h"

namespace loopgrid {

std::string FormatClosuresCsv(const std::vector<Closure>& closures) {
  std::string text = ClosureCsvHeader() + '\n';
  for (const Closure& closure : closures) text += ClosureCsvLine(closure) + '\n';
  return text;
}

}  // namespace loopgrid
