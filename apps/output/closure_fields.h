#pragma once

#include <string>

#include "apps/output/json_writer.h"
#include "frontend/closing/closure.h"

namespace loopgrid {

// What is written about a closure that was tried: columns of closures.csv, and members of the JSON
// objects of events and of the page. All come from one table of fields in closure_fields.cpp.

/// The names of the columns of closures.csv, separated by commas.
std::string ClosureCsvHeader();

/// A line of closures.csv, without its line end.
std::string ClosureCsvLine(const Closure& closure);

/// Adds the members that an event of --events has.
void AddClosureEventFields(const Closure& closure, JsonWriter* json);

/// Adds the members that the page of --view gets; with fewer digits, since it gets many closures.
void AddClosurePageFields(const Closure& closure, JsonWriter* json);

}  // namespace loopgrid
