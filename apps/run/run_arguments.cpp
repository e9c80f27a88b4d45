#include "apps/run/run_arguments.h"

#include "apps/run/run_command.h"
#include "apps/settings/mapping_options.h"

namespace loopgrid {
namespace {

constexpr const char* kRunFooter =
    "Files written to DIR, all of them or none:\n"
    "  map.png           the map: white free, black wall, grey unknown\n"
    "  map.pgm map.yaml  the same for a robot's map server\n"
    "  trajectory.tum    pose of every scan: time x y z qx qy qz qw (seconds, metres)\n"
    "  corrected.clf     the log with corrected poses, CARMEN format\n"
    "  graph.g2o         nodes and constraints with information matrices\n"
    "  closures.csv      every loop closure tried, and why it was or was not made\n"
    "  graph.png         the graph over the map, before and after\n"
    "  uncertainty.png   3 sigma ellipses of the nodes as seen from the last pose\n"
    "  report.json       counts, errors, options, times, memory";

}  // namespace

Command DescribeRun(RunOptions* options) {
  Command command{
      .name = "run",
      .summary = "Make a map of a log",
      .arguments = {{.name = "LOG",
                     .help = "The log: CARMEN text or MRPT rawlog, either may be gzipped; known by "
                             "content",
                     .target = &options->log,
                     .required = true},
                    {.name = "--out",
                     .unit = "DIR",
                     .help = "Folder to write to; made if it is not there",
                     .target = &options->out,
                     .required = true}},
      .footer = kRunFooter,
      .action = [options] { RunCommand(*options); }};
  for (Argument& argument : MappingArguments(options, nullptr)) {
    command.arguments.push_back(std::move(argument));
  }
  return command;
}

}  // namespace loopgrid
