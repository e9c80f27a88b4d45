#include "apps/run_outputs.h"

#include <cstddef>

#include "apps/closures_csv.h"
#include "apps/stopwatch.h"
#include "frontend/log/tum_file.h"
#include "mapping/map_files.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {
namespace {

OccupancyGrid DrawGrid(const Slam& slam, const std::vector<SE2>& poses, double resolution) {
  OccupancyGridOptions options;
  options.resolution = resolution;
  const auto scan_at = [&slam](std::size_t index) {
    const int scan = static_cast<int>(index);
    return MapScan{.origin = slam.scan_laser(scan).translation(),
                   .hits = slam.scan_hits(scan),
                   .no_returns = slam.scan_no_returns(scan)};
  };
  return RenderMap(poses, scan_at, options);
}

void WriteMap(const OccupancyGrid& grid, OutputDirectory* outputs, RunReport* report) {
  const GreyImage image = DrawMap(grid);
  outputs->Write("map.png", EncodePng(image));
  outputs->Write("map.pgm", EncodePgm(image));
  outputs->Write("map.yaml", MapYaml(grid, "map.pgm"));
  report->map_width = image.width;
  report->map_height = image.height;
}

Trajectory StampPoses(const Slam& slam, const std::vector<SE2>& poses) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    trajectory.push_back({slam.scan_timestamp(static_cast<int>(i)), poses[i]});
  }
  return trajectory;
}

}  // namespace

std::vector<std::string> RunOutputNames() {
  return {"map.png", "map.pgm", "map.yaml", "trajectory.tum", "closures.csv", "report.json"};
}

void WriteRunOutputs(const RunOptions& options, const Slam& slam, OutputDirectory* outputs,
                     RunReport* report) {
  const std::vector<SE2> poses = slam.ScanPoses();
  const Stopwatch drawing;
  WriteMap(DrawGrid(slam, poses, options.resolution), outputs, report);
  report->drawing_seconds = drawing.seconds();
  outputs->Write("trajectory.tum",
                 [&](const std::string& path) { WriteTumFile(path, StampPoses(slam, poses)); });
  outputs->Write("closures.csv", FormatClosuresCsv(slam.closures()));
}

}  // namespace loopgrid
