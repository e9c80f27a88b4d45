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
  std::size_t best = 0;  ///< index of the trial with the lowest F; the graph is left at its end
  /// Says whether that end is the global optimum. It exists only for kAuto and if F is a plain sum
  /// of squares: no robust loss, and errors as in ConstraintError.
  std::optional<OptimalityCertificate> certificate;
};

/// Optimises from the start that is asked for. With kAuto it tries several starts:
/// - The first start is the graph's own poses if F there is at most the number of degrees of
///   freedom, which is its expected value. Otherwise it is the own poses or the chordal guess,
///   whichever has the lower F.
/// - The other starts are tried one after the other until the lowest end found is good enough: it
///   is certified as the global optimum, or, where there is no certificate, F is at most the number
///   of degrees of freedom.
/// - A start whose poses are nearly those of an earlier start is left out.
/// If there is no chordal guess, the spanning tree takes its place. Throws as Optimizer::Optimize
/// does.
template <typename Pose>
BestStartResult OptimizeFromBestStart(PoseGraph<Pose>* graph, Optimizer<Pose>* optimizer,
                                      InitialGuess start = InitialGuess::kAuto);

}  // namespace loopgrid
