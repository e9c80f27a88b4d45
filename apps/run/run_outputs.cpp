#include "apps/run/run_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iterator>
#include <new>
#include <optional>

#include "apps/output/closures_csv.h"
#include "backend/base/stopwatch.h"
#include "backend/files/graph_file.h"
#include "frontend/log/corrected_log.h"
#include "mapping/fitted_map.h"
#include "mapping/graph_drawing.h"
#include "mapping/map_files.h"
#include "mapping/occupancy_grid.h"
#include "mapping/uncertainty_drawing.h"

namespace loopgrid {
namespace {

using ScanAt = std::function<MapScan(std::size_t)>;

ScanAt ScansOf(const Slam& slam) {
  return [&slam](std::size_t index) {
    const int scan = static_cast<int>(index);
    return MapScan{.origin = slam.scan_laser(scan).translation(),
                   .hits = slam.scan_hits(scan),
                   .no_returns = slam.scan_no_returns(scan)};
  };
}

/// The poses of the scans by odometry alone. The first one is that on the map.
std::vector<SE2> OdometryPoses(const Slam& slam, const std::vector<SE2>& poses) {
  std::vector<SE2> odometry;
  odometry.reserve(poses.size());
  const SE2 T_map_odom = poses.front() * slam.scan_odometry(0).Inverse();
  for (int scan = 0; scan < slam.scan_count(); ++scan) {
    odometry.push_back(T_map_odom * slam.scan_odometry(scan));
  }
  return odometry;
}

std::vector<SE2> NodesAmong(const Slam& slam, const std::vector<SE2>& scan_poses) {
  std::vector<SE2> nodes;
  for (int scan : slam.node_scans()) nodes.push_back(scan_poses[static_cast<std::size_t>(scan)]);
  return nodes;
}

std::vector<Eigen::Vector3d> PositionsOf(const std::vector<SE2>& nodes) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(nodes.size());
  for (const SE2& node : nodes) positions.emplace_back(node.x(), node.y(), 0.0);
  return positions;
}

std::vector<GraphEdge> EdgesOf(const PoseGraph<SE2>& graph) {
  // Constraints between nodes at most this far apart in the order of the log are not closures.
  constexpr int kOnTheWay = 10;
  std::vector<GraphEdge> edges;
  for (const Constraint<SE2>& constraint : graph.constraints) {
    const bool on_the_way = std::abs(constraint.to - constraint.from) <= kOnTheWay;
    edges.push_back(
        {constraint.from, constraint.to, on_the_way ? EdgeKind::kSequential : EdgeKind::kClosure});
  }
  return edges;
}

/// Notes about what differs from a map of all scans with cells of `resolution` metres.
std::vector<std::string> NotesAbout(const FittedMap& map, double resolution) {
  std::vector<std::string> notes;
  if (map.grid.resolution() > resolution) {
    notes.push_back(
        fmt::format("the map has cells of {:.6g} m: with cells of {:.6g} m it would be "
                    "too large",
                    map.grid.resolution(), resolution));
  }
  if (!map.left_out.empty()) {
    notes.push_back(fmt::format(
        "the map is without {} {} too far from the others for one map, the "
        "first: scan {}",
        map.left_out.size(), map.left_out.size() == 1 ? "scan that is" : "scans that are",
        map.left_out.front() + 1));
  }
  return notes;
}

/// The map as files.
struct MapOutputs {
  std::string png;
  std::string pgm;
  std::string yaml;
};

MapOutputs DrawMapOutputs(const Slam& slam, const std::vector<SE2>& poses, RunReport* report) {
  OccupancyGridOptions options;
  options.resolution = report->options.resolution;
  const FittedMap map = RenderFittedMap(poses, ScansOf(slam), options);
  const GreyImage image = DrawMap(map.grid);
  MapOutputs outputs = {
      .png = EncodePng(image), .pgm = EncodePgm(image), .yaml = MapYaml(map.grid, "map.pgm")};
  report->map_width = image.width;
  report->map_height = image.height;
  report->map_resolution = map.grid.resolution();
  std::ranges::move(NotesAbout(map, options.resolution), std::back_inserter(report->notes));
  return outputs;
}

std::string DrawGraphOutput(const Slam& slam, const std::vector<SE2>& odometry,
                            const OccupancyGrid& map) {
  const OccupancyGrid map_before = RenderBackdrop(odometry, ScansOf(slam));
  const GraphState before = {.title = "before: odometry",
                             .nodes = PositionsOf(NodesAmong(slam, odometry)),
                             .backdrop = &map_before};
  const GraphState after = {
      .title = "after optimisation", .nodes = PositionsOf(slam.graph().poses), .backdrop = &map};
  return DrawGraphBeforeAfter(before, after, EdgesOf(slam.graph()));
}

/// Calls `draw`. If it fails for any reason, for example because the picture does not fit into
/// memory, adds a note that `what` is left out. Trajectory and graph must be written also without a
/// picture.
template <typename Draw>
auto DrawOrLeaveOut(const char* what, const Draw& draw, RunReport* report)
    -> std::optional<decltype(draw())> {
  try {
    return draw();
  } catch (const std::bad_alloc&) {
    report->notes.push_back(fmt::format("{} left out: too large for the memory", what));
  } catch (const std::exception& error) {
    report->notes.push_back(fmt::format("{} left out: {}", what, error.what()));
  }
  return std::nullopt;
}

/// `content` is null if the file is left out.
void WriteOrLeaveOut(const std::string& name, const std::string* content,
                     OutputDirectory* outputs) {
  if (content == nullptr) {
    outputs->LeaveOut(name);
  } else {
    outputs->Write(name, *content);
  }
}

void WriteMap(const Slam& slam, const std::vector<SE2>& poses, OutputDirectory* outputs,
              RunReport* report) {
  const auto map = DrawOrLeaveOut(
      "map.png, map.pgm and map.yaml are", [&] { return DrawMapOutputs(slam, poses, report); },
      report);
  WriteOrLeaveOut("map.png", map ? &map->png : nullptr, outputs);
  WriteOrLeaveOut("map.pgm", map ? &map->pgm : nullptr, outputs);
  WriteOrLeaveOut("map.yaml", map ? &map->yaml : nullptr, outputs);
}

void WriteDrawings(const Slam& slam, const std::vector<SE2>& poses, OutputDirectory* outputs,
                   RunReport* report) {
  const OccupancyGrid map = RenderBackdrop(poses, ScansOf(slam));
  const auto graph = DrawOrLeaveOut(
      "graph.png is", [&] { return DrawGraphOutput(slam, OdometryPoses(slam, poses), map); },
      report);
  WriteOrLeaveOut("graph.png", graph ? &*graph : nullptr, outputs);
  const auto uncertainty = DrawOrLeaveOut(
      "uncertainty.png is",
      [&] { return DrawUncertainty(slam.graph().poses, slam.NodeCovariances(), &map); }, report);
  WriteOrLeaveOut("uncertainty.png", uncertainty ? &*uncertainty : nullptr, outputs);
}

std::vector<CorrectedScan> CorrectScans(const Slam& slam, const std::vector<SE2>& poses) {
  std::vector<CorrectedScan> scans;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    scans.push_back({poses[i], slam.scan_laser(static_cast<int>(i))});
  }
  return scans;
}

void WriteRecords(const std::string& log, const Slam& slam, const std::vector<SE2>& poses,
                  OutputDirectory* outputs) {
  outputs->Write("trajectory.tum",
                 [&](const std::string& path) { WriteTumFile(path, StampPoses(slam, poses)); });
  outputs->Write("corrected.clf", [&](const std::string& path) {
    WriteCorrectedLog(log, path, CorrectScans(slam, poses));
  });
  outputs->Write("graph.g2o", FormatGraph(slam.graph()));
  outputs->Write("closures.csv", FormatClosuresCsv(slam.closures()));
}

}  // namespace

std::vector<std::string> RunOutputNames() {
  return {"map.png",   "map.pgm",      "map.yaml",  "trajectory.tum",  "corrected.clf",
          "graph.g2o", "closures.csv", "graph.png", "uncertainty.png", "report.json"};
}

Trajectory StampPoses(const Slam& slam, const std::vector<SE2>& poses) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    trajectory.push_back({slam.scan_timestamp(static_cast<int>(i)), poses[i]});
  }
  return trajectory;
}

void WriteRunOutputs(const RunOptions& options, const Slam& slam, OutputDirectory* outputs,
                     RunReport* report) {
  const std::vector<SE2> poses = slam.ScanPoses();
  const Stopwatch drawing;
  WriteMap(slam, poses, outputs, report);
  WriteDrawings(slam, poses, outputs, report);
  report->drawing_seconds = drawing.seconds();
  const Stopwatch writing;
  WriteRecords(options.log, slam, poses, outputs);
  report->writing_seconds = writing.seconds();
}

}  // namespace loopgrid
