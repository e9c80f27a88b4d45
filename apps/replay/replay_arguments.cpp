#include <CLI/CLI.hpp>

#include "apps/cli/arguments.h"

namespace loopgrid {
namespace {

constexpr const char* kReplayFooter =
    "The log's lines are passed on byte for byte, each at its time by the time stamps of the\n"
    "scans. Steps backwards and gaps of more than 5 seconds are not waited for. With --to, it\n"
    "ends when the receiver has closed the connection.";

}  // namespace

void AddReplay(CLI::App* program, ReplayOptions* options) {
  CLI::App* replay = program->add_subcommand("replay", "Play a log as if it were just recorded");
  replay->add_option("LOG", options->log, "The log: CARMEN text, may be gzipped; known by content")
      ->required()
      ->type_name("");
  replay
      ->add_option("--speed", options->speed,
                   "Times real time; 0: as fast as the receiver takes it")
      ->capture_default_str()
      ->type_name("N");
  RequireName(replay->add_option("--to", options->to,
                                 "Connect and send the log there [default: standard output]"))
      ->type_name("HOST:PORT");
  replay->add_option("--loop", options->loop, "Play it so many times; 0: without end")
      ->capture_default_str()
      ->type_name("N");
  replay->add_option("--from-line", options->from_line, "Begin at this line")
      ->capture_default_str()
      ->type_name("L");
  replay->footer(kReplayFooter);
}

}  // namespace loopgrid
