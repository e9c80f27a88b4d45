#include "apps/plot/plot_arguments.h"

namespace loopgrid {

Command DescribePlot(PlotOptions* options) {
  return {.name = "plot",
          .summary = "Draw how the error fell, one curve a trace",
          .arguments = {{.name = "TRACE",
                         .help = "What loopgrid optimize --trace wrote; any number",
                         .target = &options->traces,
                         .required = true},
                        {.name = "--out",
                         .unit = "FILE",
                         .help = "The picture to write, PNG",
                         .target = &options->out,
                         .required = true}},
          .footer =
              "F(x) over the iterations; the axis is logarithmic if F falls by more than a "
              "factor of 20.",
          .action = [options] { PlotCommand(*options); }};
}

}  // namespace loopgrid
