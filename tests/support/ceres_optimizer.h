#pragma once

#include <string>
#include <vector>

#include "backend/graph/pose_graph.h"

namespace loopgrid::test_support {

/// A way to let Ceres optimise a pose graph.
struct CeresSettings {
  std::string name;
  bool dog_leg = false;
  bool cx_sparse = false;     ///< CXSparse instead of SuiteSparse
  double trust_radius = 1e4;  ///< the default; larger: closer to Gauss-Newton
  double function_tolerance = 1e-6;
  int max_iterations = 200;
};

/// Settings worth trying: all of them on one thread.
std::vector<CeresSettings> AllCeresSettings();

struct CeresResult {
  double final_error = 0.0;  ///< F
  int iterations = 0;
};

/// Minimises F with Ceres, on the same manifold and with the same analytic Jacobians as Optimizer.
/// Graphs without landmarks and robust losses.
template <typename Pose>
CeresResult OptimizeWithCeres(const CeresSettings& settings, PoseGraph<Pose>* graph);

}  // namespace loopgrid::test_support
