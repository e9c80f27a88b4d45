#pragma once

#include <string>

namespace loopgrid {

/// What `loopgrid eval` is asked to do.
struct EvalOptions {
  std::string estimate;   ///< trajectory to judge, TUM
  std::string reference;  ///< relations, or a reference trajectory (TUM); told apart by content
  bool json = false;      ///< print JSON instead of text
};

/// Compares a trajectory with relations or with another trajectory and prints the result. Throws
/// Error.
void EvalCommand(const EvalOptions& options);

}  // namespace loopgrid
