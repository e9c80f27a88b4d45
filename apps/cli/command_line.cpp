#include "apps/cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/cli/arguments.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr const char* kExitStatus =
    "Exit status: 0 done, 2 wrong usage, 3 an input cannot be used, 4 an output cannot be "
    "written,\n"
    "128 + n ended by signal n.";

}  // namespace

CLI::Option* RequireName(CLI::Option* option) {
  return option->check(CLI::Validator(
      [](const std::string& name) -> std::string {
        return name.empty() ? "the name is empty" : "";
      },
      ""));
}

Command ParseCommandLine(int argc, const char* const* argv) {
  RunOptions run;
  OnlineOptions online;
  EvalOptions eval;
  OptimizeOptions optimize;
  PlotOptions plot;
  ReplayOptions replay;
  CLI::App program(
      "Graph-based 2D laser SLAM: a robot's log in; map, trajectory and graph out. Its back-end\n"
      "alone: a pose graph in, 2D or 3D; the best poses and their covariances out.",
      "loopgrid");
  program.set_version_flag("--version", "loopgrid " LOOPGRID_VERSION, "Print the version and exit");
  program.footer(std::string("loopgrid COMMAND --help explains a command's options.\n") +
                 kExitStatus);
  program.require_subcommand(1);
  AddRun(&program, &run);
  AddOnline(&program, &online);
  AddEval(&program, &eval);
  AddOptimize(&program, &optimize);
  AddPlot(&program, &plot);
  AddReplay(&program, &replay);
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
  if (program.got_subcommand("online")) return online;
  if (program.got_subcommand("optimize")) return optimize;
  if (program.got_subcommand("plot")) return plot;
  if (program.got_subcommand("replay")) return replay;
  return eval;
}

}  // namespace loopgrid
