#pragma once

#include "apps/cli/command.h"
#include "apps/eval/eval_command.h"

namespace loopgrid {

/// The command `loopgrid eval`, which sets `options` and acts on them.
Command DescribeEval(EvalOptions* options);

}  // namespace loopgrid
