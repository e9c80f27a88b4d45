#include "apps/plot/plot_arguments.h"

namespace loopgrid {

Command DescribePlot(PlotOptions* options) {
  return {.name = "plot",
          .summary = "Draw F over the iterations, one curve for each trace",
          .arguments = {{.name = "TRACE",
                         .help = "A file of loopgrid optimize --trace; any number of them",
                         .target = &options->traces,
                         .required = true},
                        {.name = "--out",
                         .unit = "FILE",
                         .help = "The picture to write, PNG",
                         .target = &options->out,
                         .required = true}},
          .footer =
              "F over the iterations; the axis is logarithmic if F falls by more than a "
              "factor of 20.",
          .action = [options] { PlotCommand(*options); }};
}

}  // namespace loopgrid
