#pragma once

#include "backend/graph/pose_graph.h"

namespace loopgrid {

/// What is known about how far a point is from the lowest F there is.
struct OptimalityCertificate {
  enum class Kind {
    kGlobal,   ///< no poses have an F lower by more than 1e-6 of it (or by more than 1e-9)
    kBounded,  ///< no poses have an F below `lower_bound`
    kUnknown,  ///< the test has not succeeded; the point may be the global minimum all the same
  };

  Kind kind = Kind::kUnknown;
  double error = 0.0;        ///< F, as TotalChi2
  double lower_bound = 0.0;  ///< F is at least this at any poses and landmarks; 0 if unknown
};

/// One English phrase: "global optimum", ...
const char* ToString(OptimalityCertificate::Kind kind);

/// Tests whether the graph's poses and landmarks, where an optimiser has left them, are the global
/// minimum of TotalChi2 with the held nodes where they are. Uses Lagrangian duality over matrices
/// with orthonormal columns (Carlone et al., IROS 2015; Rosen, Carlone, Bandeira and Leonard, IJRR
/// 2019). Those papers assume isotropic information matrices. To allow any information matrix, each
/// error is replaced by a quadratic function of the pose matrices that is nowhere above the error
/// and equal to it at the present poses. The test becomes weaker the more anisotropic or correlated
/// the information is. Costs one sparse factorisation. Throws Error (kInput) if the graph is not
/// valid.
template <typename Pose>
OptimalityCertificate CertifyOptimality(const PoseGraph<Pose>& graph);

}  // namespace loopgrid
