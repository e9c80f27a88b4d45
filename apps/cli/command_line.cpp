// The only file that includes CLI11, which takes long to compile.
#include "apps/cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <span>
#include <type_traits>
#include <variant>

#include "apps/cli/unknown_names.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

/// One way to add an argument for each type of target.
class ArgumentAdder {
 public:
  ArgumentAdder(CLI::App* app, const Argument& argument) : app_(app), argument_(argument) {}

  CLI::Option* operator()(bool* target) const {
    return app_->add_flag(argument_.name, *target, argument_.help);
  }

  CLI::Option* operator()(const WordChoice& choice) const {
    const auto set = [&choice](const std::string& word) { choice.set(word); };
    return app_->add_option_function<std::string>(argument_.name, set, argument_.help)
        ->check(CLI::IsMember(choice.words))
        ->default_str(choice.preset)
        ->type_name(argument_.unit);
  }

  template <typename Value>
  CLI::Option* operator()(Value* target) const {
    CLI::Option* option = app_->add_option(argument_.name, *target, argument_.help);
    option->type_name(argument_.unit);
    if (argument_.shows_default) option->capture_default_str();
    const bool is_option = argument_.name.starts_with('-');
    if (std::is_same_v<Value, std::string> && is_option) option->check(IsNotEmpty());
    return option;
  }

 private:
  static CLI::Validator IsNotEmpty() {
    return {[](const std::string& text) { return text.empty() ? "the name is empty" : ""; }, ""};
  }

  CLI::App* app_;
  const Argument& argument_;
};

void AddCommand(CLI::App* program, const Command& command) {
  CLI::App* app = program->add_subcommand(command.name, command.summary);
  for (const Argument& argument : command.arguments) {
    CLI::Option* option = std::visit(ArgumentAdder(app, argument), argument.target);
    option->required(argument.required);
  }
  if (!command.footer.empty()) app->footer(command.footer);
}

/// The command on the command line; null if there is none.
const Command* CommandIn(const CLI::App& app, const Program& program) {
  for (const Command& command : program.commands) {
    if (app.got_subcommand(command.name)) return &command;
  }
  return nullptr;
}

void NoteGiven(const CLI::App& app, const Command& command) {
  const CLI::App* parsed = app.get_subcommand(command.name);
  for (const Argument& argument : command.arguments) {
    if (argument.given && parsed->count(argument.name) > 0) argument.given();
  }
}

}  // namespace

Invocation ParseCommandLine(const Program& program, int argc, const char* const* argv) {
  const auto words = std::span(argv, static_cast<std::size_t>(argc));
  RefuseUnknownNames(program, words.subspan(std::min<std::size_t>(1, words.size())));
  CLI::App app(program.summary, program.name);
  app.set_version_flag("--version", program.name + ' ' + program.version,
                       "Print the version and exit");
  app.footer(program.footer);
  app.require_subcommand(1);
  for (const Command& command : program.commands) AddCommand(&app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return {.answer = app.help()};
  } catch (const CLI::CallForVersion& version) {
    return {.answer = std::string(version.what()) + '\n'};
  } catch (const CLI::ParseError& error) {
    const Command* command = CommandIn(app, program);
    if (command == nullptr && words.size() <= 1)
      return {.answer = app.help(), .lacks_command = true};
    const std::string help = command == nullptr ? program.name : program.name + ' ' + command->name;
    throw Error(ErrorCode::kUsage, fmt::format("{} (see {} --help)", error.what(), help));
  }
  const Command* command = CommandIn(app, program);
  NoteGiven(app, *command);
  return {.command = command};
}

}  // namespace loopgrid
