#include "apps/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr const char* kExitStatus =
    "Exit status: 0 done, 2 wrong usage, 3 an input cannot be used, 4 an output cannot be "
    "written,\n"
    "128 + n ended by signal n.";

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

void AddRun(CLI::App* program, RunOptions* options) {
  CLI::App* run = program->add_subcommand("run", "Make a map of a log");
  run->add_option("LOG", options->log,
                  "The log: CARMEN text or MRPT rawlog, either may be gzipped; known by content")
      ->required()
      ->type_name("");
  run->add_option("--out", options->out, "Folder to write to; made if it is not there")
      ->required()
      ->type_name("DIR");
  run->add_option("--resolution", options->resolution, "Side of a map cell, 0.01 to 1 metres")
      ->capture_default_str()
      ->type_name("METRES");
  run->add_option("--node-distance", options->slam.node_distance,
                  "A new node of the graph after this much travel, 0.05 to 10 metres")
      ->capture_default_str()
      ->type_name("METRES");
  run->add_option("--node-angle", options->slam.node_angle,
                  "... or after this much turning, 0.05 to 3 radians")
      ->capture_default_str()
      ->type_name("RADIANS");
  run->add_flag("--strict", options->strict,
                "Stop at the first malformed line of the log [default: skip and count them]");
  run->add_flag("--quiet", options->quiet,
                "No progress bar [default: one if standard error is a terminal]");
  run->footer(kRunFooter);
}

void AddEval(CLI::App* program, EvalOptions* options) {
  CLI::App* eval = program->add_subcommand("eval", "Say how accurate a trajectory is");
  eval->add_option("ESTIMATE", options->estimate,
                   "The trajectory to judge, TUM format: time x y z qx qy qz qw")
      ->required()
      ->type_name("");
  eval->add_option("REFERENCE", options->reference,
                   "Relations (t1 t2 x y z roll pitch yaw; Kuemmerle et al. 2009) or a reference "
                   "trajectory in TUM format, which is aligned first; known by content")
      ->required()
      ->type_name("");
  eval->add_flag("--json", options->json, "Print JSON [default: text]");
}

}  // namespace

Command ParseCommandLine(int argc, const char* const* argv) {
  RunOptions run;
  EvalOptions eval;
  CLI::App program("Graph-based 2D laser SLAM: a robot's log in; map, trajectory and graph out.",
                   "loopgrid");
  program.set_version_flag("--version", "loopgrid " LOOPGRID_VERSION, "Print the version and exit");
  program.footer(std::string("loopgrid COMMAND --help explains a command's options.\n") +
                 kExitStatus);
  program.require_subcommand(1);
  AddRun(&program, &run);
  AddEval(&program, &eval);
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return Answer{program.help()};
  } catch (const CLI::CallForVersion& version) {
    return Answer{std::string(version.what()) + '\n'};
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::kUsage, fmt::format("{} (see loopgrid --help)", error.what()));
  }
  if (program.got_subcommand("run")) return run;
  return eval;
}

}  // namespace loopgrid
