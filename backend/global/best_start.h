#pragma once

#include <optional>
#include <vector>

#include "backend/global/global_optimality.h"
#include "backend/graph/pose_graph.h"
#include "backend/solve/optimizer.h"

namespace loopgrid {

/// Where an optimisation begins.
enum class InitialGuess {
  kAuto,          ///< see OptimizeFromBestStart
  kNone,          ///< at the graph's own poses
  kSpanningTree,  ///< SetSpanningTreeGuess
  kChordal,       ///< SetChordalGuess
};

/// As on a command line: "auto", "none", "spanning-tree", "chordal".
const char* ToString(InitialGuess guess);

/// One start and what came of it.
struct StartTrial {
  InitialGuess start = InitialGuess::kNone;
  OptimizerResult result;
};

struct BestStartResult {
  std::vector<StartTrial> trials;  ///< in the order in which they were made; at least one
  std::size_t best = 0;            ///< of these, whose end the graph is at
  /// Of that end; only for kAuto, and if F is a plain sum of squares, that is without robust losses
  /// and with errors as in ConstraintError.
  std::optional<OptimalityCertificate> certificate;
};

/// Optimises from a start of one's choice; or, with kAuto, from one that is good enough: from the
/// graph's own poses if F there is no more than expected, or otherwise, of these and the chordal
/// guess, from where F is lower. As long as the lowest end found cannot be told to be the global
/// optimum, the other starts are tried too; where there is no certificate, as long as F there is
/// more than expected, which is the number of degrees of freedom. Starts at (nearly) the same poses
/// as one that has been tried are left out. A spanning tree takes the place of a chordal guess that
/// does not exist. Throws as Optimizer::Optimize does.
template <typename Pose>
BestStartResult OptimizeFromBestStart(PoseGraph<Pose>* graph, Optimizer<Pose>* optimizer,
                                      InitialGuess start = InitialGuess::kAuto);

}  // namespace loopgrid
