#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// One end of a TCP connection.
struct HostPort {
  std::string host;  ///< a name, or an IPv4 or IPv6 address (without brackets)
  int port = 0;      ///< 0: any that is free
};

/// Reads `HOST:PORT`, an IPv6 address in brackets. Throws Error (kUsage) for anything else.
HostPort ParseHostPort(std::string_view text);

/// The text that ParseHostPort() reads.
std::string ToString(const HostPort& address);

/// Whether a host is certainly this machine: `localhost` or a loopback address. Other names are not
/// looked up, and give false.
bool IsLoopback(const std::string& host);

}  // namespace loopgrid
