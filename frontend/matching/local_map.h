#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "backend/geometry/se2.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// A piece of surface: the mean of hits in the same small square with similar normals.
struct Surfel {
  Eigen::Vector2f position;  ///< mean of the hits, metres
  Eigen::Vector2f normal;    ///< unit, towards where it was seen from; (0, 0) if unknown
  float weight = 0.0F;       ///< number of hits
};

/// A scan and its pose in the map.
struct PlacedScan {
  const PointScan* scan = nullptr;
  SE2 T_map_robot;
};

/// The surfaces seen from a few nearby nodes: what a scan is matched against.
class LocalMap {
 public:
  static constexpr float kSquare = 0.05F;  ///< side of the squares that merge hits, metres
  static constexpr float kBucket = 0.25F;  ///< reach of NearestSurface, metres

  LocalMap() = default;
  /// Hits farther than `radius` metres from `center` are left out.
  LocalMap(std::span<const PlacedScan> scans, const Eigen::Vector2d& center, double radius);

  const std::vector<Surfel>& surfels() const { return surfels_; }
  bool empty() const { return surfels_.empty(); }
  Eigen::Vector2f lower() const { return lower_; }
  Eigen::Vector2f upper() const { return upper_; }

  /// The nearest surfel with a normal within about 45 degrees of `normal`, at most kBucket away;
  /// null if there is none. Ties: the lower index.
  const Surfel* NearestSurface(const Eigen::Vector2f& point, const Eigen::Vector2f& normal) const;

 private:
  void FillBuckets();

  std::vector<Surfel> surfels_;  ///< in bucket order
  std::vector<int> bucket_begin_;
  int columns_ = 0;
  int rows_ = 0;
  Eigen::Vector2f lower_ = Eigen::Vector2f::Zero();
  Eigen::Vector2f upper_ = Eigen::Vector2f::Zero();
};

}  // namespace loopgrid
