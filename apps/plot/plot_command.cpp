#include "apps/plot/plot_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/output/png_name.h"
#include "apps/output/same_file.h"
#include "apps/output/trace_csv.h"
#include "backend/base/atomic_file.h"
#include "mapping/curve_plot.h"

namespace loopgrid {
namespace {

std::string ShortName(const std::string& path) {
  const std::filesystem::path name = std::filesystem::path(path).filename();
  return name.extension() == ".csv" ? name.stem().string() : name.string();
}

/// The file's name without its folder, unless another one has the same.
std::string CurveName(const std::string& path, const std::vector<std::string>& paths) {
  const std::string name = ShortName(path);
  const auto same = std::count_if(paths.begin(), paths.end(), [&name](const std::string& other) {
    return ShortName(other) == name;
  });
  return same == 1 ? name : path;
}

Curve ReadCurve(const std::string& path, const std::vector<std::string>& paths) {
  Curve curve{"", ReadTraceCsv(path)};
  const Eigen::Vector2d& last = curve.points.back();
  curve.name = fmt::format("{}: F = {:.6g} after {:.6g} iterations", CurveName(path, paths),
                           last.y(), last.x());
  return curve;
}

}  // namespace

void PlotCommand(const PlotOptions& options) {
  RequirePngName("--out", options.out);
  for (const std::string& path : options.traces) {
    RequireOtherThanInput("--out", options.out, path);
  }
  std::vector<Curve> curves;
  for (const std::string& path : options.traces) curves.push_back(ReadCurve(path, options.traces));
  WriteFileAtomically(options.out, DrawCurves(curves, "iteration", "F(x)"));
}

}  // namespace loopgrid
