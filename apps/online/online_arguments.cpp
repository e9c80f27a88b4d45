#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/arguments.h"

namespace loopgrid {
namespace {

constexpr const char* kFooter =
    "Lines of a CARMEN log come in; without --follow, --listen or --connect from standard input.\n"
    "When they end, or at SIGINT, SIGTERM or SIGHUP, all files of `run` are written to DIR, the\n"
    "same bytes as `run` makes of the same lines. A second signal ends at once.\n"
    "While they come, DIR has\n"
    "  journal.clf       the lines received so far, a log itself\n"
    "  session.json      the options that the session was begun with\n"
    "  map.png map.pgm map.yaml trajectory.tum graph.g2o\n"
    "                    as of a few seconds ago\n"
    "After a crash, kill -9 included, --resume DIR goes on; the sender may begin anywhere it "
    "likes\n"
    "between its first line and the one after the last that was acknowledged.\n"
    "Events are JSON, one a line: start, pose (of each scan; acknowledges its line), node, "
    "closure,\n"
    "optimization, warning, resumed, known, saved, end. If their reader stops reading, mapping "
    "and\n"
    "then the sender wait for it.";

void AddSources(CLI::App* online, OnlineOptions* options) {
  const auto add = [online](const char* name, std::string* value, const char* description,
                            const char* type) {
    RequireName(online->add_option(name, *value, description))->type_name(type);
  };
  add("--follow", &options->follow, "Read a file that is being written, also across rotation",
      "FILE");
  add("--listen", &options->listen, "Wait for a sender; a sender may come after another",
      "HOST:PORT");
  add("--connect", &options->connect, "Fetch from a sender, again and again", "HOST:PORT");
  online->add_flag("--once", options->once,
                   "End when the first sender that sent something has left "
                   "[default: wait for the next]");
}

void AddSession(CLI::App* online, OnlineOptions* options) {
  const auto add = [online](const char* name, std::string* value, const char* description) {
    RequireName(online->add_option(name, *value, description))->type_name("DIR");
  };
  add("--out", &options->run.out, "Folder for a new session; made if it is not there");
  add("--resume", &options->resume, "Go on with the session in this folder");
  add("--continue", &options->continued,
      "Start in the map of this folder, of a session or a run; the robot finds itself in it");
}

/// Notes which of the options that decide the result are given.
void NoteGiven(CLI::App* online, OnlineOptions* options) {
  static const std::vector<std::pair<std::string, std::string>> deciding = {
      {"--resolution", "resolution"},
      {"--node-distance", "node_distance"},
      {"--node-angle", "node_angle"},
      {"--strict", "strict"}};
  online->callback([online, options] {
    for (const auto& [option, field] : deciding) {
      if (online->count(option) > 0) options->given.insert(field);
    }
  });
}

}  // namespace

void AddOnline(CLI::App* program, OnlineOptions* options) {
  CLI::App* online = program->add_subcommand("online", "Make a map while the robot drives");
  AddSources(online, options);
  AddSession(online, options);
  RequireName(online->add_option("--view", options->view,
                                 "Serve a page that shows the map [default: none; to this "
                                 "machine only]"))
      ->type_name("[HOST:]PORT");
  RequireName(online->add_option("--events", options->events,
                                 "Write what happens as JSON lines; -: standard output"))
      ->type_name("FILE");
  online
      ->add_option("--interval", options->interval,
                   "Between two refreshes of the files, 0.01 to 86400 seconds")
      ->capture_default_str()
      ->type_name("SECONDS");
  online
      ->add_option("--threads", options->threads,
                   "1: loops are closed by the thread that tracks; the result is the same")
      ->capture_default_str()
      ->type_name("N");
  AddMapping(online, &options->run);
  NoteGiven(online, options);
  online->footer(kFooter);
}

}  // namespace loopgrid
