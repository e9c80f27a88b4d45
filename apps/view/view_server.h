#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "apps/online/online_update.h"
#include "apps/online/published_files.h"
#include "apps/view/live_map.h"

namespace loopgrid {

struct ViewServerOptions {
  std::string host = "127.0.0.1";  ///< address to bind to, or a name that has one
  int port = 0;                    ///< 0: any that is free
  int max_connections = 512;       ///< further ones are closed at once
  double request_timeout = 10.0;   ///< for a whole request header, also between two, seconds
  double write_timeout = 30.0;     ///< who takes nothing for so long is dropped, seconds
  double batch_interval = 0.033;   ///< viewers get news at most this often, seconds
  std::size_t max_backlog = std::size_t{1} << 20;  ///< waiting for a slow viewer, bytes

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// What `[HOST:]PORT` says, the rest being defaults. HOST may be in brackets (IPv6). Throws Error
/// (kUsage) if it makes no sense.
ViewServerOptions ParseViewAddress(std::string_view address);

/// Serves the page and the HTTP API behind it, on a thread of its own. Viewers share what they are
/// sent; one that is too slow for it skips ahead to a fresh state, so none takes more memory than
/// `max_backlog` nor slows anybody. Only GET and HEAD; no request changes anything.
class ViewServer {
 public:
  /// Binds. `map` and `files` must live longer than the server. Throws Error: kUsage if an option
  /// is not valid, kInput if the address cannot be bound.
  ViewServer(const ViewServerOptions& options, const LiveMap* map, const PublishedFiles* files);

  /// Drops all connections.
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  int port() const;          ///< the real one
  std::string url() const;   ///< of the page
  bool is_loopback() const;  ///< false: other machines can reach it

  /// Hands an update to all viewers. Returns at once.
  void Add(const OnlineUpdate& update);

  /// Tells all viewers that nothing more will come, and waits until they have been sent everything,
  /// at most two seconds.
  void Finish();

  struct Counters {
    int connections = 0;           ///< open now
    int viewers = 0;               ///< of them, those that follow /events
    std::int64_t requests = 0;     ///< answered, whatever the answer
    std::int64_t turned_away = 0;  ///< connections over the limit
    std::int64_t skips = 0;        ///< how often a slow viewer skipped ahead
  };
  Counters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopgrid
