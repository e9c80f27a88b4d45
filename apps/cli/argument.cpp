#include "apps/cli/argument.h"

#include <algorithm>

namespace loopgrid {

std::string FieldOf(const Argument& argument) {
  if (!argument.field.empty()) return argument.field;
  std::string field =
      argument.name.substr(std::min(argument.name.find_first_not_of('-'), argument.name.size()));
  std::replace(field.begin(), field.end(), '-', '_');
  return field;
}

std::string WithOptionNames(const std::string& message, const std::vector<Argument>& arguments) {
  for (const Argument& argument : arguments) {
    const std::string field = FieldOf(argument);
    if (message.starts_with(field + " is ")) return argument.name + message.substr(field.size());
  }
  return message;
}

}  // namespace loopgrid
