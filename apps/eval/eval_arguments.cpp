#include <CLI/CLI.hpp>

#include "apps/cli/arguments.h"

namespace loopgrid {

void AddEval(CLI::App* program, EvalOptions* options) {
  CLI::App* eval = program->add_subcommand("eval", "Say how accurate a trajectory is");
  eval->add_option("ESTIMATE", options->estimate,
                   "The trajectory to judge, TUM format: time x y z qx qy qz qw")
      ->required()
      ->type_name("");
  eval->add_option("REFERENCE", options->reference,
                   "Relations (t1 t2 x y z roll pitch yaw; Kuemmerle et al. 2009) or a reference "
                   "trajectory in TUM format, which is aligned first; known by content")
      ->required()
      ->type_name("");
  eval->add_flag("--json", options->json, "Print JSON [default: text]");
}

}  // namespace loopgrid
