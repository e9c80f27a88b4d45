#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace loopgrid {

struct ViewServerOptions {
  std::string host = "127.0.0.1";  ///< address to bind to, or a name that has one
  int port = 0;                    ///< 0: any that is free
  int max_connections = 512;       ///< further ones are closed at once
  double request_timeout = 10.0;   ///< for a whole request header, also between two, seconds
  double write_timeout =
      30.0;  ///< a client that takes no byte for this time is disconnected, seconds
  double batch_interval = 0.033;  ///< shortest time between two batches of events, seconds
  std::size_t max_backlog = std::size_t{1} << 20;  ///< most bytes waiting for a slow viewer

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// Options with the address `[HOST:]PORT` and the other defaults. HOST may be in brackets (IPv6).
/// Throws Error (kUsage) for other texts.
ViewServerOptions ParseViewAddress(std::string_view address);

}  // namespace loopgrid
