#pragma once

#include "backend/geometry/se2.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/matching_options.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// How a scan at a pose agrees with the surfaces of a map.
struct Visibility {
  int confirmed = 0;  ///< surfels where a beam ended
  int denied = 0;     ///< surfels that a beam went through

  /// Share of the surfels in view that the scan denies, 0..1; 1 if none is in view.
  double denied_share() const;
};

/// Compares each surfel that faces the laser with the beams in its direction. At a wrong pose every
/// hit may lie on some wall, but beams then go through other walls: many surfels are denied.
Visibility CompareVisibility(const LocalMap& map, const PointScan& scan, const SE2& T_map_robot,
                             const VisibilityOptions& options = {});

}  // namespace loopgrid
