#pragma once

#include <string>

#include "apps/cli/command.h"

namespace loopgrid {

/// What a command line asks for.
struct Invocation {
  const Command* command = nullptr;  ///< its targets are set; null: print `answer` and be done
  std::string answer = {};           ///< to --help or --version
};

/// Sets the targets of the command that the command line names. Throws Error (kUsage) if the line
/// makes no sense; the message names the nearest right command or option where one was mistyped.
Invocation ParseCommandLine(const Program& program, int argc, const char* const* argv);

}  // namespace loopgrid
