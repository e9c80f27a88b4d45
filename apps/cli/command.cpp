#include "apps/cli/command.h"

#include "backend/base/error.h"

namespace loopgrid {

void Execute(const Command& command) {
  try {
    command.action();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kUsage) throw;
    throw Error(error.code(), WithOptionNames(error.what(), command.arguments));
  }
}

}  // namespace loopgrid
