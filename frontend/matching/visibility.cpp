#include "frontend/matching/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace loopgrid {
namespace {

constexpr int kSectors = 360;
constexpr float kNothing = std::numeric_limits<float>::infinity();

// The sector that a direction in the laser frame falls into.
std::size_t SectorOf(const Eigen::Vector2f& direction) {
  const float turns =
      std::atan2(direction.y(), direction.x()) / (2.0F * std::numbers::pi_v<float>)+0.5F;
  const int sector = static_cast<int>(turns * kSectors);
  return static_cast<std::size_t>(std::clamp(sector, 0, kSectors - 1));
}

// The shortest and the longest of the beams in each sector and its neighbours.
struct Sectors {
  std::array<float, kSectors> shortest;
  std::array<float, kSectors> longest;

  Sectors(const PointScan& scan, float farthest) {
    shortest.fill(kNothing);
    longest.fill(-1.0F);
    const SE2 T_laser_robot = scan.T_robot_laser.Inverse();
    const Eigen::Matrix2f rotation = T_laser_robot.rotation().cast<float>();
    const Eigen::Vector2f translation = T_laser_robot.translation().cast<float>();
    for (const Eigen::Vector2f& hit : scan.hits) {
      const Eigen::Vector2f p = rotation * hit + translation;
      Add(SectorOf(p), p.norm());
    }
    for (const Eigen::Vector2f& direction : scan.no_returns) {
      Add(SectorOf(rotation * direction), farthest);
    }
  }

  void Add(std::size_t sector, float range) {
    for (std::size_t s : {(sector + kSectors - 1) % kSectors, sector, (sector + 1) % kSectors}) {
      shortest[s] = std::min(shortest[s], range);
      longest[s] = std::max(longest[s], range);
    }
  }
};

}  // namespace

double Visibility::denied_share() const {
  const int seen = confirmed + denied;
  return seen > 0 ? static_cast<double>(denied) / seen : 1.0;
}

Visibility CompareVisibility(const LocalMap& map, const PointScan& scan, const SE2& T_map_robot,
                             const VisibilityOptions& options) {
  const auto tolerance = static_cast<float>(options.tolerance);
  const auto nearest = static_cast<float>(options.nearest);
  const auto farthest = static_cast<float>(options.farthest);
  const auto min_facing = static_cast<float>(options.min_facing);
  const Sectors sectors(scan, farthest);
  const SE2 T_laser_map = (T_map_robot * scan.T_robot_laser).Inverse();
  const Eigen::Matrix2f rotation = T_laser_map.rotation().cast<float>();
  const Eigen::Vector2f translation = T_laser_map.translation().cast<float>();
  Visibility visibility;
  for (const Surfel& surfel : map.surfels()) {
    const Eigen::Vector2f p = rotation * surfel.position + translation;
    const float range = p.norm();
    if (range < nearest || range > farthest) continue;
    // A beam that grazes a wall passes near it without being stopped; such beams are not compared.
    if ((rotation * surfel.normal).dot(p) > -min_facing * range) continue;
    const std::size_t sector = SectorOf(p);
    if (sectors.longest[sector] < 0.0F) continue;
    if (sectors.shortest[sector] > range + tolerance) {
      ++visibility.denied;
    } else if (sectors.longest[sector] > range - tolerance) {
      ++visibility.confirmed;
    }
  }
  return visibility;
}

}  // namespace loopgrid
