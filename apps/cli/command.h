#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/cli/argument.h"

namespace loopgrid {

/// A command of the program: its arguments and its action.
struct Command {
  std::string name = {};
  std::string summary = {};  ///< one line
  std::vector<Argument> arguments = {};
  std::string footer = {};            ///< below the options in the command's help
  std::function<void()> action = {};  ///< what it does once its arguments are set; throws Error
};

/// A program that is a set of commands.
struct Program {
  std::string name = {};
  std::string version = {};
  std::string summary = {};
  std::string footer = {};  ///< below the commands in the help; also of commands without a footer
  std::vector<Command> commands = {};
};

/// Performs the command's action. Messages of its usage errors name options as the user types them.
void Execute(const Command& command);

}  // namespace loopgrid
