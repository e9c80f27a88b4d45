#pragma once

#include <set>
#include <string>

#include "apps/live/live_viewer.h"
#include "apps/settings/run_options.h"

namespace loopgrid {

/// Options of `loopgrid online`.
struct OnlineOptions {
  static constexpr double kShortestInterval = 0.01;    ///< seconds
  static constexpr double kLongestInterval = 86400.0;  ///< seconds

  // Where the lines come from: one of these, or standard input.
  std::string follow;   ///< a file that is being written
  std::string listen;   ///< HOST:PORT to wait for senders at
  std::string connect;  ///< HOST:PORT of a sender

  bool once = false;      ///< end after the first sender of a socket
  RunOptions run;         ///< run.out is the session's folder; run.log is set to its journal
  std::string resume;     ///< the folder of a session to go on with
  std::string continued;  ///< the folder of a session whose map the new one goes on with
  std::string view;       ///< the value of the viewer's option; empty: no viewer
  std::string events;     ///< file for the events, `-`: standard output
  double interval = 5.0;  ///< seconds between two refreshes of the files
  int threads = 2;        ///< 1: the mapper does everything in one thread

  LiveViewerOption viewer;  ///< how `view` is checked and the viewer started

  /// The keys of the MappingOptions() that were given; the others come from a resumed session.
  std::set<std::string> given;

  /// Throws Error (kUsage) naming the option, its value and its bounds.
  void Validate() const;
};

}  // namespace loopgrid
