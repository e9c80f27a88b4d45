#include "mapping/fitted_map.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr int kBackdropCells = 1200;

using ScanAt = std::function<MapScan(std::size_t)>;

/// A scan that has a place on the grid.
struct PlacedScan {
  std::size_t index;
  CellBox box;               // the cells that it touches
  Eigen::Vector2d p_map;     // where the robot was, metres
  double from_centre = 0.0;  // the larger of its distances along x and y, metres
};

std::optional<CellBox> PlaceOf(const OccupancyGrid& grid, const SE2& pose, const MapScan& scan) {
  try {
    return grid.BoxOf(pose, scan);
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::vector<PlacedScan> PlaceScans(std::span<const SE2> poses, const ScanAt& scan_at,
                                   const OccupancyGridOptions& options) {
  const OccupancyGrid ruler(options);
  std::vector<PlacedScan> placed;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::optional<CellBox> box = PlaceOf(ruler, poses[i], scan_at(i));
    if (box) placed.push_back({.index = i, .box = *box, .p_map = poses[i].translation()});
  }
  return placed;
}

CellBox BoxAround(std::span<const PlacedScan> scans) {
  CellBox box;
  for (const PlacedScan& scan : scans) box = box.United(scan.box);
  return box;
}

/// Decides how large the cells are and which scans are left out.
class MapFitting {
 public:
  MapFitting(const OccupancyGridOptions& options, const MapLimits& limits)
      : options_(options), limits_(limits) {}

  /// The smallest whole number by which the side of a cell has to be multiplied for `box` to fit.
  std::int64_t FactorFor(const CellBox& box) const {
    if (Fits(box.width(), box.height())) return 1;
    // Larger cells may cover a little more on every side.
    constexpr std::int64_t kBorder = 3;
    constexpr std::int64_t kLargest = std::int64_t{1} << 31;  // one cell for everything
    std::int64_t factor = 2;
    while (factor < kLargest &&
           !Fits(box.width() / factor + kBorder, box.height() / factor + kBorder)) {
      ++factor;
    }
    return factor;
  }

  /// Drops the scans that are too far from the others.
  void LeaveOutStrays(std::vector<PlacedScan>* scans) const {
    const std::int64_t for_all = FactorFor(BoxAround(*scans));
    if (for_all == 1) return;
    MeasureFromCentre(scans);
    std::vector<PlacedScan> near = *scans;
    std::ranges::stable_sort(near, {}, &PlacedScan::from_centre);
    near.resize(near.size() - std::max<std::size_t>(1, near.size() / 100));
    const std::int64_t for_most = FactorFor(BoxAround(near));
    if (for_all <= 2 * for_most && for_all <= Coarsest()) return;
    const double reach = Reach(std::min(for_most, Coarsest()));
    std::erase_if(*scans, [reach](const PlacedScan& scan) { return scan.from_centre > reach; });
  }

 private:
  bool Fits(std::int64_t width, std::int64_t height) const {
    return std::max(width, height) <= limits_.max_side && width * height <= options_.max_cells;
  }

  /// The factor that makes cells as large as they may be.
  std::int64_t Coarsest() const {
    return std::max<std::int64_t>(1, std::llround(limits_.coarsest / options_.resolution));
  }

  /// How far from its centre a square map with cells of this factor reaches, metres.
  double Reach(std::int64_t factor) const {
    const double side = std::min(static_cast<double>(limits_.max_side),
                                 std::sqrt(static_cast<double>(options_.max_cells)));
    return 0.5 * side * static_cast<double>(factor) * options_.resolution;
  }

  /// The x of the centre is the median of all x. Its y is the median of y over the scans near that
  /// x.
  void MeasureFromCentre(std::vector<PlacedScan>* scans) const {
    const auto median = [](std::vector<double> values) {
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      return *middle;
    };
    std::vector<double> values;
    for (const PlacedScan& scan : *scans) values.push_back(scan.p_map.x());
    Eigen::Vector2d centre(median(values), 0.0);
    values.clear();
    for (const PlacedScan& scan : *scans) {
      const bool is_near = std::abs(scan.p_map.x() - centre.x()) <= Reach(Coarsest());
      if (is_near) values.push_back(scan.p_map.y());
    }
    centre.y() = median(values);
    for (PlacedScan& scan : *scans) {
      const Eigen::Array2d low(static_cast<double>(scan.box.min_x),
                               static_cast<double>(scan.box.min_y));
      const Eigen::Array2d high(static_cast<double>(scan.box.max_x),
                                static_cast<double>(scan.box.max_y));
      scan.from_centre = std::max((options_.resolution * high - centre.array()).maxCoeff(),
                                  (centre.array() - options_.resolution * low).maxCoeff());
    }
  }

  const OccupancyGridOptions& options_;
  const MapLimits& limits_;
};

/// The same options for larger cells. Most of a large cell with a wall in it is free, but the
/// picture should show the wall.
OccupancyGridOptions Coarser(OccupancyGridOptions options, double factor) {
  options.resolution *= factor;
  options.hit_log_odds = std::min(10.0, factor * options.hit_log_odds);
  return options;
}

}  // namespace

FittedMap RenderFittedMap(std::span<const SE2> poses, const ScanAt& scan_at,
                          const OccupancyGridOptions& options, const MapLimits& limits) {
  const MapFitting fitting(options, limits);
  std::vector<PlacedScan> scans = PlaceScans(poses, scan_at, options);
  fitting.LeaveOutStrays(&scans);
  const CellBox box = BoxAround(scans);
  const std::int64_t factor = fitting.FactorFor(box);
  FittedMap map{
      .grid = OccupancyGrid(factor == 1 ? options : Coarser(options, static_cast<double>(factor))),
      .left_out = {}};
  CellBox needed;
  for (const PlacedScan& scan : scans) {
    needed = needed.United(map.grid.BoxOf(poses[scan.index], scan_at(scan.index)));
  }
  map.grid.Reserve(needed);
  std::size_t next = 0;  // the next scan to decide about
  for (const PlacedScan& scan : scans) {
    for (; next < scan.index; ++next) map.left_out.push_back(next);
    map.grid.AddScan(poses[scan.index], scan_at(scan.index));
    ++next;
  }
  for (; next < poses.size(); ++next) map.left_out.push_back(next);
  return map;
}

OccupancyGrid RenderBackdrop(std::span<const SE2> poses, const ScanAt& scan_at,
                             OccupancyGridOptions options) {
  const std::vector<PlacedScan> scans = PlaceScans(poses, scan_at, options);
  const CellBox box = BoxAround(scans);
  const double longest = static_cast<double>(std::max(box.width(), box.height()));
  OccupancyGrid grid(Coarser(options, std::max(1.0, longest / kBackdropCells)));
  for (const PlacedScan& scan : scans) grid.AddScan(poses[scan.index], scan_at(scan.index));
  return grid;
}

}  // namespace loopgrid
