#pragma once

#include <memory>
#include <string>

#include "apps/live/live_map.h"
#include "apps/live/live_viewer.h"
#include "apps/live/online_update.h"
#include "apps/live/published_files.h"
#include "apps/view/http_service.h"
#include "apps/view/view_options.h"

namespace loopgrid {

/// Serves the page and the HTTP API behind it, on a thread of its own. All viewers share the memory
/// of the events. A viewer that is too slow gets the whole state instead of the events it has
/// missed. So no viewer needs more memory than `max_backlog` or slows the others down. Only GET and
/// HEAD are allowed; no request changes anything.
class ViewServer : public LiveViewer {
 public:
  /// Binds. `map` and `files` must live longer than the server. Throws Error: kUsage if an option
  /// is not valid, kInput if the address cannot be bound.
  ViewServer(const ViewServerOptions& options, const LiveMap* map, const PublishedFiles* files);

  /// Closes all connections.
  ~ViewServer() override;

  int port() const;                   ///< the real one
  std::string url() const override;   ///< of the page
  bool is_loopback() const override;  ///< false: other machines can reach it

  /// Sends an update to all viewers. If the index of its scan is negative, it contains only nodes
  /// and closures. Returns at once.
  void Add(const OnlineUpdate& update) override;

  /// Sends the event `end` to all viewers. Waits, at most two seconds, until everything is sent and
  /// viewers have fetched the last tiles.
  void Finish() override;

  using Counters = HttpCounters;
  Counters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopgrid
