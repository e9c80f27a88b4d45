#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace loopgrid {

struct Curve {
  std::string name;                     ///< ASCII, for the legend
  std::vector<Eigen::Vector2d> points;  ///< in order of x
};

/// A PNG of curves over a common x axis, 1,600 pixels wide: axes with ticks, a legend above them.
/// The y axis is logarithmic if the positive values span more than a factor of 20; values that are
/// not positive are then drawn at its lower end. The curves differ in brightness, dashes and
/// markers, so that they can be told apart in grey prints. Points that are not finite are left out.
/// A plot without points is an empty frame.
std::string DrawCurves(std::span<const Curve> curves, const std::string& x_label,
                       const std::string& y_label);

}  // namespace loopgrid
