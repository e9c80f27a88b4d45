#include "mapping/graph_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "backend/base/error.h"
#include "mapping/canvas.h"
#include "mapping/map_view.h"

namespace loopgrid {
namespace {

// Pixels.
constexpr int kMaxSide = 2400;
constexpr int kMargin = 24;
constexpr int kTextHeight = 18;
constexpr int kLineHeight = 3 * kTextHeight;  // of the rows for titles, scale bars and the legend
constexpr int kMinPanelWidth = 560;           // for its title
constexpr int kMaxPanelHeight = kMaxSide - 3 * kLineHeight - 2 * kMargin;

constexpr Color kFreeColor{228, 228, 228};
constexpr Color kWallColor{130, 130, 130};
constexpr Color kSequentialColor{30, 100, 190};
constexpr Color kClosureColor{225, 75, 35};
constexpr Color kRobotColor{20, 140, 60};

constexpr int kBackdropCells = 1200;
constexpr double kSigmas = 3.0;

Eigen::AlignedBox2d ExtentOf(const GraphState& state) {
  Eigen::AlignedBox2d extent;
  if (state.backdrop != nullptr) extent = SeenExtent(*state.backdrop);
  for (const SE2& node : state.nodes) extent.extend(node.translation());
  return extent;
}

Eigen::Matrix2d PositionCovariance(const SE2& node, const Eigen::Matrix3d& covariance) {
  return node.rotation() * covariance.topLeftCorner<2, 2>() * node.rotation().transpose();
}

// Makes room for ellipses, but not for those that would dwarf the map.
Eigen::AlignedBox2d WithEllipses(Eigen::AlignedBox2d extent, const GraphState& state,
                                 std::span<const Eigen::Matrix3d> covariances) {
  const double largest = extent.isEmpty() ? 0.0 : 0.25 * extent.sizes().norm();
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    const Eigen::Vector2d reach =
        kSigmas * PositionCovariance(state.nodes[i], covariances[i]).diagonal().cwiseSqrt();
    if (!(reach.maxCoeff() <= largest)) continue;
    extent.extend(state.nodes[i].translation() + reach);
    extent.extend(state.nodes[i].translation() - reach);
  }
  return extent;
}

// How large a picture of `extent` is when scaled to fit.
Eigen::Vector2i FittedSize(const Eigen::AlignedBox2d& extent, int max_width, int max_height) {
  const Eigen::Vector2d size =
      extent.isEmpty() ? Eigen::Vector2d(1.0, 1.0) : extent.sizes().cwiseMax(1e-6);
  const double scale = std::min(max_width / size.x(), max_height / size.y());
  return (scale * size).array().ceil().cast<int>().matrix();
}

void DrawEdges(std::span<const SE2> nodes, std::span<const GraphEdge> edges, EdgeKind kind,
               Color color, int thickness, MapView* view) {
  for (const GraphEdge& edge : edges) {
    if (edge.kind != kind) continue;
    view->DrawLine(nodes[static_cast<std::size_t>(edge.from)].translation(),
                   nodes[static_cast<std::size_t>(edge.to)].translation(), color, thickness);
  }
}

void DrawBackdrop(const GraphState& state, MapView* view) {
  if (state.backdrop != nullptr) view->DrawGrid(*state.backdrop, kFreeColor, kWallColor);
}

void DrawGraphPanel(const std::string& title, const GraphState& state,
                    std::span<const GraphEdge> edges, const PixelArea& area, Canvas* canvas) {
  MapView view(canvas, area, ExtentOf(state));
  canvas->DrawText(area.left, area.top - kTextHeight, kTextHeight, title, kBlack);
  DrawBackdrop(state, &view);
  DrawEdges(state.nodes, edges, EdgeKind::kClosure, kClosureColor, 1, &view);
  DrawEdges(state.nodes, edges, EdgeKind::kSequential, kSequentialColor, 2, &view);
  view.DrawScaleBar(area.left, area.top + area.height + 2 * kTextHeight, kTextHeight);
}

// A sample of a line and what it stands for; returns where the next entry goes.
int DrawLegendEntry(int left, int base, Color color, int thickness, const std::string& text,
                    Canvas* canvas) {
  constexpr int kSample = 60;
  canvas->FillRectangle({left, base - kTextHeight / 2 - thickness / 2, kSample, thickness}, color);
  canvas->DrawText(left + kSample + kTextHeight / 2, base, kTextHeight, text, kBlack);
  return left + kSample + 3 * kTextHeight + Canvas::TextWidth(kTextHeight, text);
}

std::ptrdiff_t CountEdges(std::span<const GraphEdge> edges, EdgeKind kind) {
  return std::count_if(edges.begin(), edges.end(),
                       [kind](const GraphEdge& edge) { return edge.kind == kind; });
}

void RequireFinite(std::span<const SE2> nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].coordinates().allFinite()) continue;
    throw Error(ErrorCode::kUsage, fmt::format("the pose of node {} is not finite", i));
  }
}

void RequireNodesOf(std::span<const GraphEdge> edges, std::size_t node_count) {
  for (const GraphEdge& edge : edges) {
    const auto exists = [node_count](int node) {
      return node >= 0 && static_cast<std::size_t>(node) < node_count;
    };
    if (exists(edge.from) && exists(edge.to)) continue;
    throw Error(ErrorCode::kUsage, fmt::format("edge {} - {}: the graph has {} nodes", edge.from,
                                               edge.to, node_count));
  }
}

}  // namespace

OccupancyGrid RenderBackdrop(std::span<const SE2> poses,
                             const std::function<MapScan(std::size_t)>& scan_at,
                             OccupancyGridOptions options) {
  const OccupancyGrid ruler(options);
  CellBox box;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    box = box.United(ruler.BoxOf(poses[i], scan_at(i)));
  }
  const double longest = static_cast<double>(std::max(box.width(), box.height()));
  const double coarser = std::max(1.0, longest / kBackdropCells);
  options.resolution *= coarser;
  // A large cell with a wall in it is mostly free, but it is the wall that should be seen.
  options.hit_log_odds = std::min(10.0, coarser * options.hit_log_odds);
  return RenderMap(poses, scan_at, options);
}

std::string DrawGraphBeforeAfter(const GraphState& before, const GraphState& after,
                                 std::span<const GraphEdge> edges) {
  RequireFinite(before.nodes);
  RequireFinite(after.nodes);
  RequireNodesOf(edges, std::min(before.nodes.size(), after.nodes.size()));
  constexpr int kMaxPanelWidth = (kMaxSide - 3 * kMargin) / 2;
  const Eigen::Vector2i panel =
      FittedSize(ExtentOf(before), kMaxPanelWidth, kMaxPanelHeight)
          .cwiseMax(FittedSize(ExtentOf(after), kMaxPanelWidth, kMaxPanelHeight))
          .cwiseMax(Eigen::Vector2i(kMinPanelWidth, 1));
  const int top = kMargin + kLineHeight;
  Canvas canvas(2 * panel.x() + 3 * kMargin, panel.y() + 3 * kLineHeight + 2 * kMargin);
  DrawGraphPanel("before: odometry", before, edges, {kMargin, top, panel.x(), panel.y()}, &canvas);
  DrawGraphPanel("after optimisation", after, edges,
                 {2 * kMargin + panel.x(), top, panel.x(), panel.y()}, &canvas);

  const int base = canvas.height() - kMargin;
  const int next = DrawLegendEntry(
      kMargin, base, kSequentialColor, 4,
      fmt::format("{} sequential constraints", CountEdges(edges, EdgeKind::kSequential)), &canvas);
  DrawLegendEntry(next, base, kClosureColor, 4,
                  fmt::format("{} closures", CountEdges(edges, EdgeKind::kClosure)), &canvas);
  return canvas.EncodePng();
}

std::string DrawUncertainty(const GraphState& state, std::span<const Eigen::Matrix3d> covariances) {
  if (covariances.size() != state.nodes.size()) {
    throw Error(ErrorCode::kUsage,
                fmt::format("{} covariances for {} nodes", covariances.size(), state.nodes.size()));
  }
  RequireFinite(state.nodes);
  const Eigen::AlignedBox2d extent = WithEllipses(ExtentOf(state), state, covariances);
  const Eigen::Vector2i panel =
      FittedSize(extent, kMaxSide - 2 * kMargin, kMaxPanelHeight).cwiseMax(kMinPanelWidth);
  Canvas canvas(panel.x() + 2 * kMargin, panel.y() + 3 * kLineHeight + 2 * kMargin);
  const PixelArea area{kMargin, kMargin + kLineHeight, panel.x(), panel.y()};
  canvas.DrawText(area.left, area.top - kTextHeight, kTextHeight,
                  "uncertainty relative to the robot's last pose", kBlack);
  MapView view(&canvas, area, extent);
  DrawBackdrop(state, &view);
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    view.DrawEllipse(state.nodes[i].translation(),
                     PositionCovariance(state.nodes[i], covariances[i]), kSigmas, kSequentialColor,
                     1);
  }
  if (!state.nodes.empty()) view.DrawDot(state.nodes.back().translation(), 7.0, kRobotColor);
  view.DrawScaleBar(area.left, area.top + area.height + 2 * kTextHeight, kTextHeight);

  const int base = canvas.height() - kMargin;
  const int next =
      DrawLegendEntry(kMargin, base, kSequentialColor, 2, "3 sigma of a node", &canvas);
  DrawLegendEntry(next, base, kRobotColor, 12, "last pose", &canvas);
  return canvas.EncodePng();
}

}  // namespace loopgrid
