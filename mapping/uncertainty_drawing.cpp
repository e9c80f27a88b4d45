#include "mapping/uncertainty_drawing.h"

#include <fmt/format.h>

#include "backend/base/error.h"
#include "mapping/canvas.h"
#include "mapping/map_view.h"
#include "mapping/picture_layout.h"

namespace loopgrid {
namespace {

constexpr Color kEllipseColor{30, 100, 190};
constexpr Color kRobotColor{20, 140, 60};
constexpr double kRobotRadius = 7.0;  // pixels
constexpr double kSigmas = 3.0;

Eigen::Matrix2d PositionCovariance(const SE2& node, const Eigen::Matrix3d& covariance) {
  return node.rotation() * covariance.topLeftCorner<2, 2>() * node.rotation().transpose();
}

// The extent of nodes, map and ellipses. Ellipses that are much larger than nodes and map are not
// counted.
Eigen::AlignedBox2d ExtentOf(std::span<const SE2> nodes,
                             std::span<const Eigen::Matrix3d> covariances,
                             const OccupancyGrid* backdrop) {
  Eigen::AlignedBox2d extent;
  if (backdrop != nullptr) extent = SeenExtent(*backdrop);
  for (const SE2& node : nodes) extent.extend(node.translation());
  const double largest = extent.isEmpty() ? 0.0 : 0.25 * extent.sizes().norm();
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    const Eigen::Vector2d reach =
        kSigmas * PositionCovariance(nodes[i], covariances[i]).diagonal().cwiseSqrt();
    if (!(reach.maxCoeff() <= largest)) continue;
    extent.extend(nodes[i].translation() + reach);
    extent.extend(nodes[i].translation() - reach);
  }
  return extent;
}

}  // namespace

std::string DrawUncertainty(std::span<const SE2> nodes,
                            std::span<const Eigen::Matrix3d> covariances,
                            const OccupancyGrid* backdrop) {
  if (covariances.size() != nodes.size()) {
    throw Error(ErrorCode::kUsage,
                fmt::format("{} covariances for {} nodes", covariances.size(), nodes.size()));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].IsFinite()) continue;
    throw Error(ErrorCode::kUsage, fmt::format("the pose of node {} is not finite", i));
  }
  const Eigen::AlignedBox2d extent = ExtentOf(nodes, covariances, backdrop);
  const Eigen::Vector2i panel =
      FittedSize(extent, kMaxPictureSide - 2 * kPictureMargin, kMaxPanelHeight)
          .cwiseMax(kMinPanelWidth);
  Canvas canvas(panel.x() + 2 * kPictureMargin, panel.y() + 3 * kTextRow + 2 * kPictureMargin);
  const PixelArea area{kPictureMargin, kPictureMargin + kTextRow, panel.x(), panel.y()};
  canvas.DrawText(area.left, area.top - kTextHeight, kTextHeight,
                  "uncertainty relative to the robot's last pose", kBlack);
  MapView view(&canvas, area, extent);
  if (backdrop != nullptr) view.DrawGrid(*backdrop, kFreeColor, kWallColor);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    view.DrawEllipse(nodes[i].translation(), PositionCovariance(nodes[i], covariances[i]), kSigmas,
                     kEllipseColor, 1);
  }
  if (!nodes.empty()) view.DrawDot(nodes.back().translation(), kRobotRadius, kRobotColor);
  view.DrawScaleBar(area.left, area.top + area.height + 2 * kTextHeight, kTextHeight);

  const int base = canvas.height() - kPictureMargin;
  const int next =
      DrawLegendLine(kPictureMargin, base, kEllipseColor, 2, "3 sigma of a node", &canvas);
  DrawLegendDot(next, base, kRobotColor, kRobotRadius, "last pose", &canvas);
  return canvas.EncodePng();
}

}  // namespace loopgrid
