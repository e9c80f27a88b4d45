#pragma once

#include <string>

namespace loopgrid {

/// Options of `loopgrid eval`.
struct EvalOptions {
  std::string estimate;     ///< trajectory to evaluate, TUM
  std::string reference;    ///< relations, or a reference trajectory (TUM)
  bool relations = false;   ///< read the reference as relations
  bool trajectory = false;  ///< read the reference as a trajectory
  bool json = false;        ///< print JSON instead of text

  /// Throws Error (kUsage) if the options contradict each other.
  void Validate() const;
};

/// Compares a trajectory with relations or with another trajectory and prints the result. Throws
/// Error.
void EvalCommand(const EvalOptions& options);

}  // namespace loopgrid
