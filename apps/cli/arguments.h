#pragma once

#include "apps/eval/eval_command.h"
#include "apps/online/online_options.h"
#include "apps/optimize/optimize_options.h"
#include "apps/plot/plot_command.h"
#include "apps/replay/replay_options.h"
#include "apps/settings/run_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace loopgrid {

/// Refuses an empty file name, which is what a shell makes of a variable that is not set.
CLI::Option* RequireName(CLI::Option* option);

/// The options that all mapping has: resolution, nodes, strictness, quiet.
void AddMapping(CLI::App* command, RunOptions* options);

// What the commands take, one function a command; each adds its command to the program.

void AddRun(CLI::App* program, RunOptions* options);
void AddOnline(CLI::App* program, OnlineOptions* options);
void AddEval(CLI::App* program, EvalOptions* options);
void AddOptimize(CLI::App* program, OptimizeOptions* options);
void AddPlot(CLI::App* program, PlotOptions* options);
void AddReplay(CLI::App* program, ReplayOptions* options);

}  // namespace loopgrid
