#pragma once

#include <string>

#include "apps/cli/command.h"

namespace loopgrid {

/// The meaning of a command line.
struct Invocation {
  const Command* command = nullptr;  ///< its targets are set; null: only print `answer`
  std::string answer = {};           ///< to --help or --version, or the help if no command is named
  bool lacks_command = false;        ///< no command is named: a usage error
};

/// Sets the targets of the command that the command line names. Throws Error (kUsage) if the line
/// is wrong; for a mistyped command or option the message names the most similar one.
Invocation ParseCommandLine(const Program& program, int argc, const char* const* argv);

}  // namespace loopgrid
