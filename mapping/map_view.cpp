#include "mapping/map_view.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mapping/axis.h"

namespace loopgrid {
namespace {

struct CellRange {
  std::int64_t begin;
  std::int64_t end;
};

// The cells that begin within [start, start + step): so each cell belongs to one pixel. If cells
// are larger than pixels, it is the cell in which the pixel begins. Cut to [lowest, highest).
CellRange CellsUnderPixel(double start, double step, std::int64_t lowest, std::int64_t highest) {
  const auto cut = [&](double cell) {
    return static_cast<std::int64_t>(
        std::clamp(cell, static_cast<double>(lowest), static_cast<double>(highest)));
  };
  const CellRange range{cut(std::ceil(start)), cut(std::ceil(start + step))};
  if (std::ceil(start) < std::ceil(start + step)) return range;
  return {cut(std::floor(start)), cut(std::floor(start) + 1.0)};
}

}  // namespace

Eigen::AlignedBox2d SeenExtent(const OccupancyGrid& grid) {
  const CellBox box = grid.SeenBox();
  Eigen::AlignedBox2d extent;
  if (box.empty()) return extent;
  const auto corner = [&grid](std::int64_t x, std::int64_t y) -> Eigen::Vector2d {
    return grid.resolution() * Eigen::Vector2d(static_cast<double>(x), static_cast<double>(y));
  };
  extent.extend(corner(box.min_x, box.min_y));
  extent.extend(corner(box.max_x, box.max_y));
  return extent;
}

MapView::MapView(Canvas* canvas, const PixelArea& area, const Eigen::AlignedBox2d& extent)
    : canvas_(canvas), area_(area) {
  const Eigen::Vector2d centre =
      extent.isEmpty() ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(extent.center());
  const Eigen::Vector2d size =
      extent.isEmpty() ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(extent.sizes());
  const double widen = size.maxCoeff() > 0.0 ? 0.0 : 1.0;
  scale_ = std::min(area.width / (size.x() + widen), area.height / (size.y() + widen));
  top_left_ = centre + Eigen::Vector2d(-0.5 * area.width, 0.5 * area.height) / scale_;
}

Eigen::Vector2d MapView::ToPixel(const Eigen::Vector2d& p_map) const {
  return {area_.left + scale_ * (p_map.x() - top_left_.x()),
          area_.top + scale_ * (top_left_.y() - p_map.y())};
}

void MapView::DrawGrid(const OccupancyGrid& grid, Color free, Color wall) {
  const CellBox box = grid.SeenBox();
  const double cells_per_pixel = 1.0 / (scale_ * grid.resolution());
  const Eigen::Vector2d first = top_left_ / grid.resolution();
  for (int j = 0; j < area_.height; ++j) {
    const CellRange rows = CellsUnderPixel(first.y() - (j + 1) * cells_per_pixel, cells_per_pixel,
                                           box.min_y, box.max_y);
    for (int i = 0; i < area_.width; ++i) {
      const CellRange columns =
          CellsUnderPixel(first.x() + i * cells_per_pixel, cells_per_pixel, box.min_x, box.max_x);
      CellState state = CellState::kUnknown;
      for (std::int64_t y = rows.begin; y < rows.end; ++y) {
        for (std::int64_t x = columns.begin; x < columns.end; ++x) {
          state = std::max(state, grid.State(x, y));
        }
      }
      if (state == CellState::kUnknown) continue;
      canvas_->SetPixel(area_.left + i, area_.top + j, state == CellState::kWall ? wall : free);
    }
  }
}

void MapView::DrawLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Color color,
                       int thickness) {
  canvas_->DrawLine(area_, ToPixel(from), ToPixel(to), color, thickness);
}

void MapView::DrawFineLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Color color,
                           double opacity) {
  canvas_->DrawFineLine(area_, ToPixel(from), ToPixel(to), color, opacity);
}

void MapView::DrawDot(const Eigen::Vector2d& centre, double radius_pixels, Color color) {
  // A thick line of length zero with round ends is a disc. Like any line it is cut at the border.
  canvas_->DrawLine(area_, ToPixel(centre), ToPixel(centre), color,
                    std::max(1, static_cast<int>(std::lround(2.0 * radius_pixels))));
}

bool MapView::DrawEllipse(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                          double sigmas, Color color, int thickness) {
  if (!covariance.allFinite() || !mean.allFinite()) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  const Eigen::Vector2d variances = eigen.eigenvalues();
  // Rounding may leave a singular covariance with an eigenvalue a little below zero.
  if (variances.x() < -1e-9 * std::abs(variances.y())) return false;
  const Eigen::Vector2d axes = sigmas * variances.cwiseMax(0.0).cwiseSqrt();
  // A corner about every three pixels, up to a number beyond which no difference is visible.
  const double perimeter = 2.0 * std::numbers::pi * axes.maxCoeff() * scale_;
  const int corners = std::clamp(static_cast<int>(std::min(perimeter, 1e4) / 3.0), 16, 720);
  const auto corner = [&](int k) -> Eigen::Vector2d {
    const double angle = 2.0 * std::numbers::pi * k / corners;
    const Eigen::Vector2d on_circle(std::cos(angle), std::sin(angle));
    return mean + eigen.eigenvectors() * axes.cwiseProduct(on_circle);
  };
  for (int k = 0; k < corners; ++k) DrawLine(corner(k), corner(k + 1), color, thickness);
  return true;
}

void MapView::DrawScaleBar(int left, int base, int text_height) {
  const double metres = RoundDown(0.25 * area_.width / scale_);
  const int length = static_cast<int>(std::lround(metres * scale_));
  const int thickness = std::max(2, text_height / 4);
  canvas_->FillRectangle({left, base - thickness, length, thickness}, kBlack);
  canvas_->DrawText(left + length + text_height, base, text_height, fmt::format("{} m", metres),
                    kBlack);
}

}  // namespace loopgrid
