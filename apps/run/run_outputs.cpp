#include "apps/run/run_outputs.h"

#include <cstddef>
#include <cstdlib>
#include <functional>

#include "apps/output/closures_csv.h"
#include "backend/base/stopwatch.h"
#include "backend/files/graph_file.h"
#include "frontend/log/corrected_log.h"
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

/// Where odometry alone would have put the scans, with the first one where it is on the map.
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
  // Nodes that are no further apart than this in the order of the log met on the way, not again.
  constexpr int kOnTheWay = 10;
  std::vector<GraphEdge> edges;
  for (const Constraint<SE2>& constraint : graph.constraints) {
    const bool on_the_way = std::abs(constraint.to - constraint.from) <= kOnTheWay;
    edges.push_back(
        {constraint.from, constraint.to, on_the_way ? EdgeKind::kSequential : EdgeKind::kClosure});
  }
  return edges;
}

void WriteMap(const Slam& slam, const std::vector<SE2>& poses, double resolution,
              OutputDirectory* outputs, RunReport* report) {
  OccupancyGridOptions options;
  options.resolution = resolution;
  const OccupancyGrid grid = RenderMap(poses, ScansOf(slam), options);
  const GreyImage image = DrawMap(grid);
  outputs->Write("map.png", EncodePng(image));
  outputs->Write("map.pgm", EncodePgm(image));
  outputs->Write("map.yaml", MapYaml(grid, "map.pgm"));
  report->map_width = image.width;
  report->map_height = image.height;
}

void WriteDrawings(const Slam& slam, const std::vector<SE2>& poses, OutputDirectory* outputs) {
  const std::vector<SE2> odometry = OdometryPoses(slam, poses);
  const std::vector<SE2> nodes_before = NodesAmong(slam, odometry);
  const std::vector<SE2>& nodes_after = slam.graph().poses;
  const OccupancyGrid map_before = RenderBackdrop(odometry, ScansOf(slam));
  const OccupancyGrid map_after = RenderBackdrop(poses, ScansOf(slam));
  const GraphState before = {
      .title = "before: odometry", .nodes = PositionsOf(nodes_before), .backdrop = &map_before};
  const GraphState after = {
      .title = "after optimisation", .nodes = PositionsOf(nodes_after), .backdrop = &map_after};
  outputs->Write("graph.png", DrawGraphBeforeAfter(before, after, EdgesOf(slam.graph())));
  outputs->Write("uncertainty.png",
                 DrawUncertainty(nodes_after, slam.NodeCovariances(), &map_after));
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
  WriteMap(slam, poses, options.resolution, outputs, report);
  WriteDrawings(slam, poses, outputs);
  report->drawing_seconds = drawing.seconds();
  const Stopwatch writing;
  WriteRecords(options.log, slam, poses, outputs);
  report->writing_seconds = writing.seconds();
}

}  // namespace loopgrid
