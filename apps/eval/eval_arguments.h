#pragma once

#include "apps/cli/command.h"
#include "apps/eval/eval_command.h"

namespace loopgrid {

/// The command `loopgrid eval`. It sets `options` and then runs with them.
Command DescribeEval(EvalOptions* options);

}  // namespace loopgrid
