#include <CLI/CLI.hpp>

#include "apps/cli/arguments.h"

namespace loopgrid {

void AddPlot(CLI::App* program, PlotOptions* options) {
  CLI::App* plot = program->add_subcommand("plot", "Draw how the error fell, one curve a trace");
  plot->add_option("TRACE", options->traces, "What loopgrid optimize --trace wrote; any number")
      ->required()
      ->type_name("");
  RequireName(plot->add_option("--out", options->out, "The picture to write, PNG"))
      ->required()
      ->type_name("FILE");
  plot->footer(
      "F(x) over the iterations; the axis is logarithmic if F falls by more than a factor of 20.");
}

}  // namespace loopgrid
