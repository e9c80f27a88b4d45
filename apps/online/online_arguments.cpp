#include "apps/online/online_arguments.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "apps/online/online_command.h"
#include "apps/settings/mapping_options.h"

namespace loopgrid {
namespace {

constexpr const char* kOnlineFooter =
    "Reads lines of a CARMEN log; without --follow, --listen or --connect from standard input.\n"
    "When they end, or at SIGINT, SIGTERM or SIGHUP, all files of `run` are written to DIR, with\n"
    "the same bytes that `run` makes of the same lines. The same signal again within one second\n"
    "counts as one; any other second signal ends the program at once. Until then DIR has\n"
    "  journal.clf       the lines received so far, a log itself\n"
    "  session.json      the options that the session was begun with\n"
    "  map.png map.pgm map.yaml trajectory.tum graph.g2o\n"
    "                    as of a few seconds ago\n"
    "After a crash or kill -9, --resume DIR goes on. The sender may begin at any line from its\n"
    "first one to the one after the last that was acknowledged.\n"
    "Events are JSON, one a line: start, pose (of each scan; acknowledges its line), node,\n"
    "closure, optimization, warning, resumed, known, saved, end. If the events are not read,\n"
    "mapping waits, and then the sender.";

std::vector<Argument> SourceArguments(OnlineOptions* options) {
  return {{.name = "--follow",
           .unit = "FILE",
           .help = "Read a file that is being written, also across rotation",
           .target = &options->follow},
          {.name = "--listen",
           .unit = "HOST:PORT",
           .help = "Wait for senders, one after the other",
           .target = &options->listen},
          {.name = "--connect",
           .unit = "HOST:PORT",
           .help = "Connect to a sender; if there is none, try again without end",
           .target = &options->connect},
          {.name = "--once",
           .help = "End when the first sender that sent something has left [default: wait for the "
                   "next]",
           .target = &options->once}};
}

std::vector<Argument> SessionArguments(OnlineOptions* options) {
  return {{.name = "--out",
           .unit = "DIR",
           .help = "Folder for a new session; made if it is not there",
           .target = &options->run.out},
          {.name = "--resume",
           .unit = "DIR",
           .help = "Go on with the session in this folder",
           .target = &options->resume},
          {.name = "--continue",
           .unit = "DIR",
           .help = "Begin in the map of this session or run; the robot may be anywhere in it",
           .target = &options->continued}};
}

std::vector<Argument> LiveArguments(OnlineOptions* options) {
  const LiveViewerOption& viewer = options->viewer;
  return {{.name = viewer.name, .unit = viewer.unit, .help = viewer.help, .target = &options->view},
          {.name = "--events",
           .unit = "FILE",
           .help = "Write what happens as JSON lines; -: standard output",
           .target = &options->events},
          {.name = "--interval",
           .unit = "SECONDS",
           .help = fmt::format("Time between two refreshes of the files, {} to {:.0f} seconds",
                               OnlineOptions::kShortestInterval, OnlineOptions::kLongestInterval),
           .target = &options->interval,
           .shows_default = true},
          {.name = "--threads",
           .unit = "N",
           .help = "1: loops are closed by the thread that tracks; the result is the same",
           .target = &options->threads,
           .shows_default = true}};
}

}  // namespace

Command DescribeOnline(OnlineOptions* options, LiveViewerOption viewer) {
  options->viewer = std::move(viewer);
  Command command{.name = "online",
                  .summary = "Make a map while the robot drives",
                  .footer = kOnlineFooter,
                  .action = [options] { OnlineCommand(*options); }};
  for (std::vector<Argument> group :
       {SourceArguments(options), SessionArguments(options), LiveArguments(options),
        MappingArguments(&options->run, &options->given)}) {
    std::move(group.begin(), group.end(), std::back_inserter(command.arguments));
  }
  return command;
}

}  // namespace loopgrid
