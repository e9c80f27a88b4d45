#include "mapping/occupancy_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr double kEvidencePerLogOdds = 100.0;

// Cells beyond this index do not exist, so that widths and areas of boxes cannot overflow.
constexpr std::int64_t kMaxCellIndex = std::int64_t{1} << 30;

void RequireBetween(const char* field, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("{} is {}, expected {} to {}", field, value, low, high));
}

int ToEvidence(double log_odds) {
  return static_cast<int>(std::lround(log_odds * kEvidencePerLogOdds));
}

CellBox BoxOfCell(GridPoint p) { return {p.cell_x(), p.cell_y(), p.cell_x() + 1, p.cell_y() + 1}; }

// Adds a margin, so that a map that grows scan by scan is seldom copied.
CellBox WithMargin(const CellBox& old_box, const CellBox& needed) {
  const std::int64_t margin = 64 + std::max(needed.width(), needed.height()) / 4;
  CellBox box = needed;
  if (old_box.empty()) return box;
  if (needed.min_x < old_box.min_x) box.min_x -= margin;
  if (needed.min_y < old_box.min_y) box.min_y -= margin;
  if (needed.max_x > old_box.max_x) box.max_x += margin;
  if (needed.max_y > old_box.max_y) box.max_y += margin;
  return box;
}

}  // namespace

void OccupancyGridOptions::Validate() const {
  RequireBetween("resolution", resolution, 0.001, 1e5);
  RequireBetween("hit_log_odds", hit_log_odds, 0.01, 10.0);
  RequireBetween("miss_log_odds", miss_log_odds, -10.0, -0.01);
  RequireBetween("max_log_odds", max_log_odds, 0.01, 300.0);
  RequireBetween("no_return_range", no_return_range, 0.0, 1000.0);
  RequireBetween("max_cells", static_cast<double>(max_cells), 1.0, 1e11);
}

bool CellBox::Contains(const CellBox& other) const {
  return other.empty() || (other.min_x >= min_x && other.min_y >= min_y && other.max_x <= max_x &&
                           other.max_y <= max_y);
}

CellBox CellBox::United(const CellBox& other) const {
  if (other.empty()) return *this;
  if (empty()) return other;
  return {std::min(min_x, other.min_x), std::min(min_y, other.min_y), std::max(max_x, other.max_x),
          std::max(max_y, other.max_y)};
}

OccupancyGrid::OccupancyGrid(const OccupancyGridOptions& options) : options_(options) {
  options_.Validate();
  grid_points_per_metre_ = static_cast<double>(GridPoint::kOne) / options_.resolution;
  hit_ = ToEvidence(options_.hit_log_odds);
  miss_ = ToEvidence(options_.miss_log_odds);
  limit_ = ToEvidence(options_.max_log_odds);
}

GridPoint OccupancyGrid::ToGrid(const Eigen::Vector2d& p_map) const {
  constexpr double kLimit = static_cast<double>(kMaxCellIndex << GridPoint::kFractionBits);
  const Eigen::Vector2d p = p_map * grid_points_per_metre_;
  if (!(std::abs(p.x()) < kLimit && std::abs(p.y()) < kLimit)) {
    throw Error(ErrorCode::kInput,
                fmt::format("the point ({}, {}) cannot be put on the map", p_map.x(), p_map.y()));
  }
  return {static_cast<std::int64_t>(std::floor(p.x())),
          static_cast<std::int64_t>(std::floor(p.y()))};
}

void OccupancyGrid::Project(const SE2& T_map_scan, const MapScan& scan, Beams* beams) const {
  beams->origin = ToGrid(T_map_scan * scan.origin);
  beams->hits.clear();
  for (const Eigen::Vector2f& hit : scan.hits) {
    beams->hits.push_back(ToGrid(T_map_scan * hit.cast<double>()));
  }
  beams->no_return_ends.clear();
  for (const Eigen::Vector2f& direction : scan.no_returns) {
    const Eigen::Vector2d end = scan.origin + options_.no_return_range * direction.cast<double>();
    beams->no_return_ends.push_back(ToGrid(T_map_scan * end));
  }
}

CellBox OccupancyGrid::BoxOf(const Beams& beams) {
  CellBox box = BoxOfCell(beams.origin);
  for (GridPoint p : beams.hits) box = box.United(BoxOfCell(p));
  for (GridPoint p : beams.no_return_ends) box = box.United(BoxOfCell(p));
  return box;
}

CellBox OccupancyGrid::BoxOf(const SE2& T_map_scan, const MapScan& scan) const {
  Beams beams;
  Project(T_map_scan, scan, &beams);
  return BoxOf(beams);
}

void OccupancyGrid::RequireAffordable(const CellBox& box) const {
  if (box.width() * box.height() <= options_.max_cells) return;
  throw Error(
      ErrorCode::kUsage,
      fmt::format("the map would span {:.6g} m x {:.6g} m: {} x {} cells of {} m, more than "
                  "max_cells = {}; take a coarser resolution",
                  static_cast<double>(box.width()) * options_.resolution,
                  static_cast<double>(box.height()) * options_.resolution, box.width(),
                  box.height(), options_.resolution, options_.max_cells));
}

void OccupancyGrid::Reserve(const CellBox& box) {
  if (box_.Contains(box)) return;
  const CellBox grown = box_.United(box);
  RequireAffordable(grown);
  std::vector<Cell> cells(static_cast<std::size_t>(grown.width() * grown.height()));
  for (std::int64_t y = box_.min_y; y < box_.max_y; ++y) {
    const auto row = cells_.begin() + (y - box_.min_y) * box_.width();
    std::copy(row, row + box_.width(),
              cells.begin() + (y - grown.min_y) * grown.width() + (box_.min_x - grown.min_x));
  }
  cells_ = std::move(cells);
  box_ = grown;
}

std::size_t OccupancyGrid::IndexOf(std::int64_t cell_x, std::int64_t cell_y) const {
  return static_cast<std::size_t>((cell_y - box_.min_y) * box_.width() + cell_x - box_.min_x);
}

// Scan numbers have 16 bits. When they are used up, all cells are reset to "no scan" and counting
// begins again.
std::uint16_t OccupancyGrid::NextScanNumber() {
  if (scan_number_ == std::numeric_limits<std::uint16_t>::max()) {
    for (Cell& cell : cells_) cell.last_scan = 0;
    scan_number_ = 0;
  }
  return ++scan_number_;
}

void OccupancyGrid::AddScan(const SE2& T_map_scan, const MapScan& scan) {
  Project(T_map_scan, scan, &beams_);
  const CellBox needed = box_.United(BoxOf(beams_));
  if (!box_.Contains(needed)) {
    RequireAffordable(needed);
    const CellBox roomy = WithMargin(box_, needed);
    Reserve(roomy.width() * roomy.height() <= options_.max_cells ? roomy : needed);
  }
  MarkHits(NextScanNumber());
  ClearRays(scan_number_);
}

void OccupancyGrid::MarkHits(std::uint16_t scan_number) {
  for (GridPoint hit : beams_.hits) {
    Cell& cell = cells_[IndexOf(hit.cell_x(), hit.cell_y())];
    if (cell.last_scan == scan_number) continue;
    cell.last_scan = scan_number;
    cell.evidence = static_cast<std::int16_t>(std::min(cell.evidence + hit_, limit_));
  }
}

// This loop takes most of the time of map drawing. It uses local variables, which stay in
// registers.
void OccupancyGrid::ClearRays(std::uint16_t scan_number) {
  const std::int64_t origin = box_.min_y * box_.width() + box_.min_x;
  const auto clear = [cells = cells_.data(), origin, scan_number, width = box_.width(),
                      miss = miss_, lowest = -limit_](std::int64_t x, std::int64_t y) {
    Cell& cell = cells[y * width + x - origin];
    const int change =
        miss * (cell.last_scan != scan_number);  // a branch would often be mispredicted
    cell.evidence = static_cast<std::int16_t>(std::max(cell.evidence + change, lowest));
    cell.last_scan = scan_number;
  };
  for (GridPoint hit : beams_.hits) WalkRay(beams_.origin, hit, clear);
  for (GridPoint end : beams_.no_return_ends) WalkRay(beams_.origin, end, clear);
}

const OccupancyGrid::Cell* OccupancyGrid::Find(std::int64_t cell_x, std::int64_t cell_y) const {
  if (!box_.Contains({cell_x, cell_y, cell_x + 1, cell_y + 1})) return nullptr;
  return &cells_[IndexOf(cell_x, cell_y)];
}

double OccupancyGrid::LogOdds(std::int64_t cell_x, std::int64_t cell_y) const {
  const Cell* cell = Find(cell_x, cell_y);
  return cell == nullptr ? 0.0 : cell->evidence / kEvidencePerLogOdds;
}

CellState OccupancyGrid::State(std::int64_t cell_x, std::int64_t cell_y) const {
  const Cell* cell = Find(cell_x, cell_y);
  if (cell == nullptr || cell->evidence == 0) return CellState::kUnknown;
  return cell->evidence > 0 ? CellState::kWall : CellState::kFree;
}

CellBox OccupancyGrid::SeenBox() const {
  CellBox seen;
  for (std::int64_t y = box_.min_y; y < box_.max_y; ++y) {
    for (std::int64_t x = box_.min_x; x < box_.max_x; ++x) {
      if (State(x, y) != CellState::kUnknown) seen = seen.United({x, y, x + 1, y + 1});
    }
  }
  return seen;
}

OccupancyGrid RenderMap(std::span<const SE2> poses,
                        const std::function<MapScan(std::size_t)>& scan_at,
                        const OccupancyGridOptions& options) {
  OccupancyGrid grid(options);
  CellBox box;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    try {
      box = box.United(grid.BoxOf(poses[i], scan_at(i)));
    } catch (const Error& error) {
      throw Error(error.code(), fmt::format("scan {}: {}", i, error.what()));
    }
  }
  grid.Reserve(box);
  for (std::size_t i = 0; i < poses.size(); ++i) grid.AddScan(poses[i], scan_at(i));
  return grid;
}

}  // namespace loopgrid
