#pragma once

#include <string>
#include <vector>

namespace loopgrid {

/// What `loopgrid plot` is asked to do.
struct PlotOptions {
  std::vector<std::string> traces;  ///< CSV, as `loopgrid optimize --trace` writes them
  std::string out;                  ///< the PNG to write
};

/// Draws F(x) over the iterations, one curve a trace, into one picture. Throws Error.
void PlotCommand(const PlotOptions& options);

}  // namespace loopgrid
