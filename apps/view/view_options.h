#pragma once

#include <cstddef>
#include <string>

namespace loopgrid {

/// Options of the server of the page.
struct ViewServerOptions {
  std::string host = "127.0.0.1";  ///< address to bind to, or a name that has one
  int port = 0;                    ///< 0: any that is free
  int max_connections = 512;       ///< further ones are closed at once
  double request_timeout = 10.0;   ///< for a whole request header, also between two, seconds
  double write_timeout = 30.0;     ///< a client is disconnected after it took no byte for this
                                   ///< time, seconds
  double batch_interval = 0.033;   ///< shortest time between two batches of events, seconds
  std::size_t max_backlog = std::size_t{1} << 20;  ///< most bytes waiting for a slow viewer

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
