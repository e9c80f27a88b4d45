#pragma once

namespace loopgrid {

/// Throws Error (kUsage) naming the field, its value and its bounds if `value` is not a finite
/// number from `low` to `high`.
void RequireBetween(const char* field, double value, double low, double high);

}  // namespace loopgrid
