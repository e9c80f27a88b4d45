#include "apps/cli/unknown_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "apps/cli/nearest_name.h"
#include "backend/base/error.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

bool IsHelp(std::string_view word) { return word == "--help" || word.starts_with("-h"); }

bool IsOption(std::string_view word) { return word.starts_with('-') && word != "-"; }

Error Refusal(const char* what, std::string_view word, const std::vector<std::string>& names,
              const std::string& help) {
  const std::string nearest = NearestName(word, names);
  const std::string suggestion = nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
  return Error(ErrorCode::kUsage, fmt::format("there is no {} {}{} (see {} --help)", what,
                                              Quoted(word), suggestion, help));
}

std::vector<std::string> OptionsOf(const Command& command) {
  std::vector<std::string> names;
  for (const Argument& argument : command.arguments) {
    if (IsOption(argument.name)) names.push_back(argument.name);
  }
  names.emplace_back("--help");
  return names;
}

/// Checks the words after the command.
void RefuseUnknownOptions(const std::string& program, const Command& command,
                          std::span<const char* const> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--") return;  // what follows are names of files
    if (!IsOption(word) || IsHelp(word)) continue;
    const std::string_view name = word.substr(0, word.find('='));
    const auto known =
        std::find_if(command.arguments.begin(), command.arguments.end(),
                     [name](const Argument& argument) { return argument.name == name; });
    if (known == command.arguments.end()) {
      throw Refusal("option", name, OptionsOf(command), program + ' ' + command.name);
    }
    const bool has_value = !std::holds_alternative<bool*>(known->target);
    if (has_value && name.size() == word.size()) ++i;  // the next word is the value
  }
}

}  // namespace

void RefuseUnknownNames(const Program& program, std::span<const char* const> words) {
  if (words.empty() || IsHelp(words[0]) || std::string_view(words[0]) == "--version") return;
  if (IsOption(words[0])) {
    throw Refusal("option", words[0], {"--help", "--version"}, program.name);
  }
  std::vector<std::string> names;
  for (const Command& command : program.commands) {
    if (command.name == words[0]) {
      return RefuseUnknownOptions(program.name, command, words.subspan(1));
    }
    names.push_back(command.name);
  }
  throw Refusal("command", words[0], names, program.name);
}

}  // namespace loopgrid
