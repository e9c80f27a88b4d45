#include "apps/live/moving_map.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr double kToleratedCells = 0.5;
constexpr double kLever = 10.0;  // metres

bool HasMoved(const SE2& from, const SE2& to, double resolution) {
  const Eigen::Vector3d motion = to.Boxminus(from);
  return motion.head<2>().norm() + kLever * std::abs(motion.z()) > kToleratedCells * resolution;
}

MapScan ToMapScan(const PointScan& points) {
  return {.origin = points.T_robot_laser.translation(),
          .hits = points.hits,
          .no_returns = points.no_returns};
}

}  // namespace

MovingMap::MovingMap(const OccupancyGridOptions& options) : grid_(options) {}

// The pose of the scan's node, which may be new.
SE2& MovingMap::NodePose(const ScanOnMap& scan) {
  const auto node = static_cast<std::size_t>(scan.place.node);
  if (node >= nodes_.size()) {
    nodes_.resize(node + 1, scan.T_map_robot * scan.place.T_node_robot.Inverse());
  }
  return nodes_[node];
}

bool MovingMap::Draw(const Entry& entry, const SE2& T_map_node, OccupancyGrid* grid,
                     CellBox* extent) {
  const SE2 T_map_robot = T_map_node * entry.place.T_node_robot;
  const MapScan scan = ToMapScan(*entry.points);
  try {
    grid->AddScan(T_map_robot, scan);
    *extent = extent->United(grid->BoxOf(T_map_robot, scan));
    return true;
  } catch (const Error&) {  // not finite, or too far out
    return false;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

void MovingMap::AddScan(const ScanOnMap& scan) {
  const SE2& T_map_node = NodePose(scan);
  scans_.push_back({scan.place, scan.points});
  for (std::size_t i = drawn_nodes_.size(); i < nodes_.size(); ++i) {
    drawn_nodes_.push_back(nodes_[i]);
  }
  if (!scan.localized) return;
  outdated_ = outdated_ || drawable_ + 1 < scans_.size();  // scans were waiting to be drawn
  drawable_ = scans_.size();
  CellBox box;
  if (!Draw(scans_.back(), T_map_node, &grid_, &box)) ++left_out_;
  extent_ = extent_.United(box);
  changes_ = changes_.United(box);
}

void MovingMap::MoveNodes(std::span<const SE2> poses) {
  nodes_.resize(std::max(nodes_.size(), poses.size()));
  std::copy(poses.begin(), poses.end(), nodes_.begin());
  CompareWithDrawn();
}

void MovingMap::CompareWithDrawn() {
  for (std::size_t i = 0; i < drawn_nodes_.size() && !outdated_; ++i) {
    outdated_ = HasMoved(drawn_nodes_[i], nodes_[i], grid_.resolution());
  }
}

void MovingMap::StartRedraw() {
  next_.emplace(Redraw{.grid = OccupancyGrid(grid_.options()), .nodes = nodes_, .extent = {}});
  outdated_ = false;
}

void MovingMap::ContinueRedraw(std::size_t scans) {
  const std::size_t end = std::min(drawable_, next_->drawn + scans);
  for (; next_->drawn < end; ++next_->drawn) {
    const Entry& entry = scans_[next_->drawn];
    const auto node = static_cast<std::size_t>(entry.place.node);
    for (std::size_t i = next_->nodes.size(); i <= node; ++i) next_->nodes.push_back(nodes_[i]);
    if (!Draw(entry, next_->nodes[node], &next_->grid, &next_->extent)) ++next_->left_out;
  }
  if (next_->drawn == drawable_) FinishRedraw();
}

void MovingMap::FinishRedraw() {
  changes_ = changes_.United(extent_).United(next_->extent);
  grid_ = std::move(next_->grid);
  drawn_nodes_ = std::move(next_->nodes);
  extent_ = next_->extent;
  left_out_ = next_->left_out;
  next_.reset();
  CompareWithDrawn();  // nodes may have moved since the redraw began
}

CellBox MovingMap::TakeChanges() { return std::exchange(changes_, CellBox{}); }

}  // namespace loopgrid
