#pragma once

#include <string>

namespace loopgrid {

/// What `loopgrid eval` is asked to do.
struct EvalOptions {
  std::string estimate;     ///< trajectory to judge, TUM
  std::string reference;    ///< relations, or a reference trajectory (TUM); told apart by content
  bool relations = false;   ///< the reference holds relations, whatever it looks like
  bool trajectory = false;  ///< the reference holds a trajectory, whatever it looks like
  bool json = false;        ///< print JSON instead of text

  /// Throws Error (kUsage) if the options contradict each other.
  void Validate() const;
};

/// Compares a trajectory with relations or with another trajectory and prints the result. Throws
/// Error.
void EvalCommand(const EvalOptions& options);

}  // namespace loopgrid
