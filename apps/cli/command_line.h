#pragma once

#include <string>
#include <variant>

#include "apps/eval/eval_command.h"
#include "apps/online/online_options.h"
#include "apps/optimize/optimize_options.h"
#include "apps/plot/plot_command.h"
#include "apps/replay/replay_options.h"
#include "apps/settings/run_options.h"

namespace loopgrid {

/// Text to print and be done with: the answer to --help and --version.
struct Answer {
  std::string text;
};

using Command = std::variant<RunOptions, OnlineOptions, ReplayOptions, EvalOptions, OptimizeOptions,
                             PlotOptions, Answer>;

/// What the arguments ask for. Throws Error (kUsage) if they make no sense.
Command ParseCommandLine(int argc, const char* const* argv);

}  // namespace loopgrid
