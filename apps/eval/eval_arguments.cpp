#include "apps/eval/eval_arguments.h"

namespace loopgrid {

Command DescribeEval(EvalOptions* options) {
  return {
      .name = "eval",
      .summary = "Say how accurate a trajectory is",
      .arguments =
          {{.name = "ESTIMATE",
            .help = "The trajectory to evaluate, TUM format: time x y z qx qy qz qw",
            .target = &options->estimate,
            .required = true},
           {.name = "REFERENCE",
            .help = "Relations (t1 t2 x y z roll pitch yaw; Kuemmerle et al. 2009) or a reference "
                    "trajectory in TUM format, which is aligned first; known by content",
            .target = &options->reference,
            .required = true},
           {.name = "--relations",
            .help = "Read REFERENCE as relations [default: known by content]",
            .target = &options->relations},
           {.name = "--reference",
            .help = "Read REFERENCE as a trajectory [default: known by content]",
            .target = &options->trajectory},
           {.name = "--json", .help = "Print JSON [default: text]", .target = &options->json}},
      .action = [options] { EvalCommand(*options); }};
}

}  // namespace loopgrid
