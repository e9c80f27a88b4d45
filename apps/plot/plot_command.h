#pragma once

#include <string>
#include <vector>

namespace loopgrid {

/// Options of `loopgrid plot`.
struct PlotOptions {
  std::vector<std::string> traces;  ///< CSV, as `loopgrid optimize --trace` writes them
  std::string out;                  ///< the PNG to write
};

/// Draws F over the iterations into one picture, with one curve for each trace. Throws Error.
void PlotCommand(const PlotOptions& options);

}  // namespace loopgrid
