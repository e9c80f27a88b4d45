#include "mapping/graph_drawing.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "backend/base/error.h"
#include "backend/base/index.h"
#include "mapping/canvas.h"
#include "mapping/color.h"
#include "mapping/graph_colors.h"
#include "mapping/map_view.h"
#include "mapping/picture_layout.h"

namespace loopgrid {
namespace {

constexpr double kLandmarkRadius = 4.0;  // pixels
constexpr double kBorder = 0.008;        // free space around the graph, share of its larger side

// Direction from which an oblique view looks: degrees from x to y, and degrees above the horizon.
constexpr double kAzimuth = -55.0;
constexpr double kElevation = 28.0;
constexpr double kPalest = 0.75;  // share of white in the colour of what is farthest away

/// A parallel projection: the axes of the picture and the direction away from the eye.
struct Projection {
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  Eigen::Vector3d away = -Eigen::Vector3d::UnitZ();

  Eigen::Vector2d operator()(const Eigen::Vector3d& p) const { return {right.dot(p), up.dot(p)}; }
};

Projection ProjectionOf(Viewpoint viewpoint) {
  if (viewpoint == Viewpoint::kAbove) return {};
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double c = std::cos(kDegree * kAzimuth);
  const double s = std::sin(kDegree * kAzimuth);
  const double horizontal = std::cos(kDegree * kElevation);
  const double vertical = std::sin(kDegree * kElevation);
  return {.right = {-s, c, 0.0},
          .up = {-vertical * c, -vertical * s, horizontal},
          .away = {-horizontal * c, -horizontal * s, -vertical}};
}

/// A state of a graph as it appears in the plane of the picture.
struct Panel {
  std::vector<Eigen::Vector2d> nodes;
  std::vector<double> depths;  // for each node, the share of all nodes that is nearer
  std::vector<Eigen::Vector2d> landmarks;
  Eigen::AlignedBox2d extent;
};

Panel Project(const GraphState& state, Viewpoint viewpoint) {
  const Projection project = ProjectionOf(viewpoint);
  Panel panel;
  if (state.backdrop != nullptr) panel.extent = SeenExtent(*state.backdrop);
  for (const Eigen::Vector3d& node : state.nodes) {
    panel.nodes.push_back(project(node));
    panel.extent.extend(panel.nodes.back());
    panel.depths.push_back(project.away.dot(node));
  }
  for (const Eigen::Vector3d& landmark : state.landmarks) {
    panel.landmarks.push_back(project(landmark));
    panel.extent.extend(panel.landmarks.back());
  }
  if (!panel.extent.isEmpty()) {
    const Eigen::Vector2d border =
        Eigen::Vector2d::Constant(kBorder * panel.extent.sizes().maxCoeff());
    panel.extent = {panel.extent.min() - border, panel.extent.max() + border};
  }
  // Shares use the whole range of shades, however the depths are distributed. Nodes that are
  // equally far get equal shares.
  std::vector<double> sorted = panel.depths;
  std::sort(sorted.begin(), sorted.end());
  for (double& depth : panel.depths) {
    const auto nearer = std::lower_bound(sorted.begin(), sorted.end(), depth) - sorted.begin();
    depth = static_cast<double>(nearer) / static_cast<double>(sorted.size());
  }
  return panel;
}

double DepthOf(const GraphEdge& edge, const Panel& panel) {
  return 0.5 * (panel.depths[ToIndex(edge.from)] + panel.depths[ToIndex(edge.to)]);
}

/// The order in which edges are drawn: far ones first. Of equally far ones the robot's path is
/// last.
std::vector<int> BackToFront(std::span<const GraphEdge> edges, const Panel& panel) {
  std::vector<int> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const double depth_a = DepthOf(edges[ToIndex(a)], panel);
    const double depth_b = DepthOf(edges[ToIndex(b)], panel);
    if (depth_a != depth_b) return depth_a > depth_b;
    return edges[ToIndex(a)].kind == EdgeKind::kClosure &&
           edges[ToIndex(b)].kind != edges[ToIndex(a)].kind;
  });
  return order;
}

/// Width and opacity of lines.
struct Pen {
  bool is_broad;   // two pixels
  double opacity;  // of lines one pixel wide
};

/// Chooses thinner lines for graphs with many edges. `ink` is the share of the picture that lines
/// one pixel wide would cover if no two of them met.
Pen PenFor(double ink) {
  constexpr double kBroadest = 0.03;
  constexpr double kDensest = 0.35;
  constexpr double kFaintest = 0.04;
  return {ink < kBroadest, std::clamp(kDensest / ink, kFaintest, 1.0)};
}

double InkOf(std::span<const GraphEdge> edges, EdgeKind kind, const Panel& panel,
             const PixelArea& area, double pixels_per_metre) {
  double pixels = 0.0;
  for (const GraphEdge& edge : edges) {
    if (edge.kind != kind) continue;
    const Eigen::Vector2d way = panel.nodes[ToIndex(edge.to)] - panel.nodes[ToIndex(edge.from)];
    pixels += std::max(1.0, pixels_per_metre * way.norm());
  }
  return pixels / (1.0 * area.width * area.height);
}

void DrawEdges(std::span<const GraphEdge> edges, const Panel& panel, const PixelArea& area,
               MapView* view) {
  const double scale = view->pixels_per_metre();
  const Pen sequential = PenFor(InkOf(edges, EdgeKind::kSequential, panel, area, scale));
  const Pen closure = PenFor(InkOf(edges, EdgeKind::kClosure, panel, area, scale));
  for (int k : BackToFront(edges, panel)) {
    const GraphEdge& edge = edges[ToIndex(k)];
    const bool is_closure = edge.kind == EdgeKind::kClosure;
    const Color color =
        Mix(is_closure ? kClosureColor : kSequentialColor, kWhite, kPalest * DepthOf(edge, panel));
    const Eigen::Vector2d& from = panel.nodes[ToIndex(edge.from)];
    const Eigen::Vector2d& to = panel.nodes[ToIndex(edge.to)];
    if (!is_closure && sequential.is_broad) {
      view->DrawLine(from, to, color, 2);
    } else {
      view->DrawFineLine(from, to, color, is_closure ? closure.opacity : sequential.opacity);
    }
  }
}

/// The directions of x, y and z in an oblique view, in the lower right corner of its row.
void DrawAxes(int right, int base, Canvas* canvas) {
  constexpr double kLength = 2.0 * kTextHeight;
  constexpr int kLetter = kTextHeight - 4;
  const Projection project = ProjectionOf(Viewpoint::kOblique);
  const PixelArea area{0, 0, canvas->width(), canvas->height()};
  const Eigen::Vector2d origin(right - 3.0 * kTextHeight, base);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector2d in_plane = project(Eigen::Vector3d::Unit(axis));
    const Eigen::Vector2d direction(in_plane.x(), -in_plane.y());
    const Eigen::Vector2d end = origin + kLength * direction;
    canvas->DrawLine(area, origin, end, kBlack, 1);
    const Eigen::Vector2d letter = end + 0.5 * kLetter * direction.normalized();
    canvas->DrawText(static_cast<int>(letter.x()) - kLetter / 3,
                     static_cast<int>(letter.y()) + kLetter / 3, kLetter,
                     std::string(1, static_cast<char>('x' + axis)), kBlack);
  }
}

void DrawPanel(const GraphState& state, const Panel& panel, std::span<const GraphEdge> edges,
               Viewpoint viewpoint, const PixelArea& area, Canvas* canvas) {
  MapView view(canvas, area, panel.extent);
  canvas->DrawText(area.left, area.top - kTextHeight, kTextHeight, state.title, kBlack);
  if (state.backdrop != nullptr) view.DrawGrid(*state.backdrop, kFreeColor, kWallColor);
  DrawEdges(edges, panel, area, &view);
  for (const Eigen::Vector2d& landmark : panel.landmarks) {
    view.DrawDot(landmark, kLandmarkRadius, kLandmarkColor);
  }
  const int base = area.top + area.height + 2 * kTextHeight;
  view.DrawScaleBar(area.left, base, kTextHeight);
  if (viewpoint == Viewpoint::kOblique) DrawAxes(area.left + area.width, base, canvas);
}

void DrawGraphLegend(std::span<const GraphEdge> edges, std::size_t landmarks, Canvas* canvas) {
  const auto closures = std::count_if(edges.begin(), edges.end(), [](const GraphEdge& edge) {
    return edge.kind == EdgeKind::kClosure;
  });
  const auto counted = [](std::ptrdiff_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  const int base = canvas->height() - kPictureMargin;
  int next = DrawLegendLine(kPictureMargin, base, kSequentialColor, 4,
                            counted(std::ssize(edges) - closures, "sequential constraint"), canvas);
  next = DrawLegendLine(next, base, kClosureColor, 4, counted(closures, "closure"), canvas);
  if (landmarks == 0) return;
  DrawLegendDot(next, base, kLandmarkColor, kLandmarkRadius,
                counted(static_cast<std::ptrdiff_t>(landmarks), "landmark"), canvas);
}

void RequireFinite(std::span<const Eigen::Vector3d> points, const char* what) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) continue;
    throw Error(ErrorCode::kUsage, fmt::format("the position of {} {} is not finite", what, i));
  }
}

void RequireNodesOf(std::span<const GraphEdge> edges, std::size_t node_count) {
  for (const GraphEdge& edge : edges) {
    const auto exists = [node_count](int node) { return node >= 0 && ToIndex(node) < node_count; };
    if (exists(edge.from) && exists(edge.to)) continue;
    throw Error(ErrorCode::kUsage, fmt::format("edge {} - {}: the graph has {} nodes", edge.from,
                                               edge.to, node_count));
  }
}

}  // namespace

std::string DrawGraphBeforeAfter(const GraphState& before, const GraphState& after,
                                 std::span<const GraphEdge> edges, Viewpoint viewpoint) {
  for (const GraphState* state : {&before, &after}) {
    RequireFinite(state->nodes, "node");
    RequireFinite(state->landmarks, "landmark");
  }
  RequireNodesOf(edges, std::min(before.nodes.size(), after.nodes.size()));
  constexpr int kMaxPanelWidth = (kMaxPictureSide - 3 * kPictureMargin) / 2;
  const Panel left = Project(before, viewpoint);
  const Panel right = Project(after, viewpoint);
  const Eigen::Vector2i size =
      FittedSize(left.extent, kMaxPanelWidth, kMaxPanelHeight)
          .cwiseMax(FittedSize(right.extent, kMaxPanelWidth, kMaxPanelHeight))
          .cwiseMax(Eigen::Vector2i(kMinPanelWidth, 1));
  const int top = kPictureMargin + kTextRow;
  Canvas canvas(2 * size.x() + 3 * kPictureMargin, size.y() + 3 * kTextRow + 2 * kPictureMargin);
  DrawPanel(before, left, edges, viewpoint, {kPictureMargin, top, size.x(), size.y()}, &canvas);
  DrawPanel(after, right, edges, viewpoint,
            {2 * kPictureMargin + size.x(), top, size.x(), size.y()}, &canvas);
  DrawGraphLegend(edges, after.landmarks.size(), &canvas);
  return canvas.EncodePng();
}

}  // namespace loopgrid
