#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "apps/view/http_connection.h"
#include "apps/view/view_options.h"

namespace loopgrid {

struct HttpCounters {
  int connections = 0;           ///< open now
  int viewers = 0;               ///< of them, those that follow events
  std::int64_t requests = 0;     ///< well-formed requests, with any answer
  std::int64_t turned_away = 0;  ///< connections over the limit
  std::int64_t skips = 0;        ///< how often a slow viewer got a snapshot instead of events
};

/// An HTTP/1.1 server for GET and HEAD, with server-sent events, on a thread of its own. A
/// connection takes no more memory than its header (8 KiB), a reply that all connections share, and
/// `max_backlog`.
class HttpService {
 public:
  /// Binds; Start() begins to serve. Throws Error (kInput) if the address cannot be bound.
  explicit HttpService(const ViewServerOptions& options);

  /// Closes all connections.
  ~HttpService();
  HttpService(const HttpService&) = delete;
  HttpService& operator=(const HttpService&) = delete;

  /// Call once. `content` must live longer than this object.
  void Start(HttpContent* content);

  int port() const;
  std::string url() const;
  bool is_loopback() const;

  /// Waits until all events so far are sent to all viewers, at most `seconds`.
  void WaitUntilSent(double seconds);

  HttpCounters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopgrid
