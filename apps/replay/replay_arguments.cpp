#include "apps/replay/replay_arguments.h"

#include "apps/replay/replay_command.h"

namespace loopgrid {
namespace {

constexpr const char* kReplayFooter =
    "The log's lines are passed on byte for byte, each at its time by the time stamps of the\n"
    "scans. It does not wait where they step back or jump by more than 5 seconds. With --to, it\n"
    "ends when the receiver has closed the connection.";

}  // namespace

Command DescribeReplay(ReplayOptions* options) {
  return {.name = "replay",
          .summary = "Play a log as if it were just recorded",
          .arguments = {{.name = "LOG",
                         .help = "The log: CARMEN text, may be gzipped; known by content",
                         .target = &options->log,
                         .required = true},
                        {.name = "--speed",
                         .unit = "N",
                         .help = "Times real time; 0: as fast as the receiver takes it",
                         .target = &options->speed,
                         .shows_default = true},
                        {.name = "--to",
                         .unit = "HOST:PORT",
                         .help = "Connect and send the log there [default: standard output]",
                         .target = &options->to},
                        {.name = "--loop",
                         .unit = "N",
                         .help = "Play it so many times; 0: without end",
                         .target = &options->loop,
                         .shows_default = true},
                        {.name = "--from-line",
                         .unit = "L",
                         .help = "Begin at this line",
                         .target = &options->from_line,
                         .shows_default = true}},
          .footer = kReplayFooter,
          .action = [options] { ReplayCommand(*options); }};
}

}  // namespace loopgrid
