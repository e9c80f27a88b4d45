#include "apps/optimize/optimize_arguments.h"

#include <iterator>
#include <utility>
#include <vector>

#include "apps/optimize/optimize_command.h"

namespace loopgrid {
namespace {

constexpr const char* kOptimizeFooter =
    "All files are written, or none. If one cannot be written, the command fails at the start.\n"
    "  --out        the graph with its new poses: TORO if the name ends in .graph or .toro, else\n"
    "               g2o; gzipped if it ends in .gz\n"
    "  --picture    constraints before and after, landmarks as dots\n"
    "  --trace      iteration, F, chi2 (F without losses and Euler angles), damping, step, "
    "seconds\n"
    "  --marginals  id and the upper triangle of the covariance; nodes in their own frame, order\n"
    "               (x, y, theta) or (x, y, z, vector part of the quaternion), landmarks in the\n"
    "               map's; metres and radians; 0: held, inf: not joined to it";

std::vector<Argument> OutputArguments(OptimizeOptions* options) {
  return {{.name = "--out",
           .unit = "FILE",
           .help = "Write the optimised graph here",
           .target = &options->out},
          {.name = "--picture",
           .unit = "FILE",
           .help = "Draw the graph before and after, PNG",
           .target = &options->picture},
          {.name = "--trace",
           .unit = "FILE",
           .help = "Write F after every iteration, CSV (see loopgrid plot)",
           .target = &options->trace},
          {.name = "--marginals",
           .unit = "FILE",
           .help = "Write the covariances of nodes and landmarks, CSV",
           .target = &options->marginals},
          {.name = "--relative-to",
           .unit = "ID",
           .help = "Covariances relative to this node [default: to the held node of each part]",
           .target = &options->relative_to}};
}

std::vector<Argument> SolverArguments(OptimizeOptions* options) {
  return {
      {.name = "--method",
       .help = "Levenberg-Marquardt, Gauss-Newton or Powell's dog leg",
       .target = OneOf(kMethods, options->method, &options->method)},
      {.name = "--parametrization",
       .help = "On the manifold (the tutorial's Algorithm 2), by the exponential map, or as if\n"
               "angles were Euclidean (Algorithm 1)",
       .target = OneOf(kParametrizations, options->parametrization, &options->parametrization)},
      {.name = "--init",
       .help =
           "Where to start; none: at the poses in the file; auto: from these in turn, until the\n"
           "end is proved to be the optimum (with euler: none)",
       .target = OneOf(kInitialGuesses, options->init, &options->init)},
      {.name = "--max-iterations",
       .unit = "N",
       .help = "At most so many iterations for each start",
       .target = &options->max_iterations,
       .shows_default = true},
      {.name = "--tolerance",
       .unit = "SHARE",
       .help = "Stop when a step would lower F by less than this share of it",
       .target = &options->tolerance,
       .shows_default = true,
       .field = "relative_decrease"},
      {.name = "--threads",
       .unit = "N",
       .help = "The result does not depend on it [default: all cores]",
       .target = &options->threads}};
}

std::vector<Argument> LossArguments(OptimizeOptions* options) {
  return {
      {.name = "--loss",
       .help = "Robust loss for constraints that may be wrong; gnc: geman-mcclure, graduated",
       .target = OneOf(kLosses, options->loss, &options->loss)},
      {.name = "--loss-width",
       .unit = "SIGMA",
       .help = "Up to this many standard deviations the loss is (nearly) the square [default: 3]",
       .target = &options->loss_width,
       .field = "robust loss width"},
      {.name = "--robust",
       .help = "Constraints with this loss; closures: all that do not join consecutive ids",
       .target = OneOf(kRobustSets, RobustSet::kClosures, &options->robust)}};
}

std::vector<Argument> OtherArguments(OptimizeOptions* options) {
  return {
      {.name = "--lenient",
       .help = "Pass over lines with an unknown tag, and set negative eigenvalues of information\n"
               "matrices to zero [default: refuse the file]",
       .target = &options->lenient},
      {.name = "--json", .help = "Print JSON [default: text]", .target = &options->json},
      {.name = "--quiet",
       .help = "Do not show progress [default: shown if standard error is a terminal]",
       .target = &options->quiet}};
}

}  // namespace

Command DescribeOptimize(OptimizeOptions* options) {
  Command command{
      .name = "optimize",
      .summary = "Find the best poses of a pose graph",
      .arguments = {{.name = "GRAPH",
                     .help = "The graph: g2o or TORO, 2D or 3D, may be gzipped; known by content",
                     .target = &options->graph,
                     .required = true}},
      .footer = kOptimizeFooter,
      .action = [options] { OptimizeCommand(*options); }};
  for (std::vector<Argument> group : {OutputArguments(options), SolverArguments(options),
                                      LossArguments(options), OtherArguments(options)}) {
    std::move(group.begin(), group.end(), std::back_inserter(command.arguments));
  }
  return command;
}

}  // namespace loopgrid
