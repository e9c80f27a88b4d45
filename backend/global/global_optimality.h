#pragma once

#include "backend/graph/pose_graph.h"

namespace loopgrid {

/// What is known about how far a point is from the lowest F there is.
struct OptimalityCertificate {
  enum class Kind {
    kGlobal,   ///< no poses have a lower F, to within a share of 1e-6 (or 1e-9)
    kBounded,  ///< no poses have an F below `lower_bound`
    kUnknown,  ///< could not be told: the test is sufficient, not necessary
  };

  Kind kind = Kind::kUnknown;
  double error = 0.0;        ///< F, as TotalChi2
  double lower_bound = 0.0;  ///< of F at any poses and landmarks; 0 where nothing better is known
};

/// One English phrase: "global optimum", ...
const char* ToString(OptimalityCertificate::Kind kind);

/// Tells whether the graph's poses and landmarks, where an optimiser has left them, are the global
/// minimum of TotalChi2 with the held nodes where they are: by Lagrangian duality over matrices
/// with orthonormal columns (Carlone et al., IROS 2015; Rosen, Carlone, Bandeira and Leonard, IJRR
/// 2019). These ask for isotropic information; here each error is replaced by a quadratic function
/// of the pose matrices that is nowhere above it and touches it at the present poses, so that any
/// information matrix will do: the stronger its anisotropy or correlations, the weaker the test.
/// One sparse factorisation. Throws Error (kInput) if the graph is not valid.
template <typename Pose>
OptimalityCertificate CertifyOptimality(const PoseGraph<Pose>& graph);

}  // namespace loopgrid
