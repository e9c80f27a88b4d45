#pragma once

#include <memory>
#include <string>

#include "apps/live/live_map.h"
#include "apps/live/online_update.h"
#include "apps/live/published_files.h"
#include "apps/view/http_service.h"
#include "apps/view/view_options.h"

namespace loopgrid {

/// Serves the page and the HTTP API behind it, on a thread of its own. Viewers share what they are
/// sent. A viewer that is too slow skips ahead to a fresh state, so none takes more memory than
/// `max_backlog` nor slows the others down. Only GET and HEAD; no request changes anything.
class ViewServer {
 public:
  /// Binds. `map` and `files` must live longer than the server. Throws Error: kUsage if an option
  /// is not valid, kInput if the address cannot be bound.
  ViewServer(const ViewServerOptions& options, const LiveMap* map, const PublishedFiles* files);

  /// Closes all connections.
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  int port() const;          ///< the real one
  std::string url() const;   ///< of the page
  bool is_loopback() const;  ///< false: other machines can reach it

  /// Hands an update to all viewers; one with a negative index of the scan tells of nodes and
  /// closures only. Returns at once.
  void Add(const OnlineUpdate& update);

  /// Tells all viewers that nothing more will come. Waits until they have been sent everything and
  /// have fetched the last pieces of the map, at most two seconds.
  void Finish();

  using Counters = HttpCounters;
  Counters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopgrid
