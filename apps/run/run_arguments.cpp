#include <CLI/CLI.hpp>

#include "apps/cli/arguments.h"

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

void AddMapping(CLI::App* command, RunOptions* options) {
  command->add_option("--resolution", options->resolution, "Side of a map cell, 0.01 to 1 metres")
      ->capture_default_str()
      ->type_name("METRES");
  command
      ->add_option("--node-distance", options->slam.node_distance,
                   "A new node of the graph after this much travel, 0.05 to 10 metres")
      ->capture_default_str()
      ->type_name("METRES");
  command
      ->add_option("--node-angle", options->slam.node_angle,
                   "... or after this much turning, 0.05 to 3 radians")
      ->capture_default_str()
      ->type_name("RADIANS");
  command->add_flag("--strict", options->strict,
                    "Stop at the first malformed line of the log [default: skip and count them]");
  command->add_flag("--quiet", options->quiet,
                    "No progress bar [default: one if standard error is a terminal]");
}

void AddRun(CLI::App* program, RunOptions* options) {
  CLI::App* run = program->add_subcommand("run", "Make a map of a log");
  run->add_option("LOG", options->log,
                  "The log: CARMEN text or MRPT rawlog, either may be gzipped; known by content")
      ->required()
      ->type_name("");
  run->add_option("--out", options->out, "Folder to write to; made if it is not there")
      ->required()
      ->type_name("DIR");
  AddMapping(run, options);
  run->footer(kRunFooter);
}

}  // namespace loopgrid
