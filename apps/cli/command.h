#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/cli/argument.h"

namespace loopgrid {

/// A command of the program: what it takes and what it does.
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
  std::string footer = {};  ///< below the commands in the help, and where a command has none
  std::vector<Command> commands = {};
};

/// Performs the command's action. Messages of its usage errors name options as the user types them.
void Execute(const Command& command);

}  // namespace loopgrid
