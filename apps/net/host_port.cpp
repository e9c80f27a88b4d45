#include "apps/net/host_port.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include "backend/base/error.h"
#include "backend/base/parse_number.h"

namespace loopgrid {

HostPort ParseHostPort(std::string_view text) {
  const auto refuse = [text](const char* problem) {
    return Error(ErrorCode::kUsage, fmt::format("{} {}", Quoted(text), problem));
  };
  const std::size_t colon = text.rfind(':');
  std::string_view host = text.substr(0, colon);
  if (colon == text.npos || host.empty()) throw refuse("is not HOST:PORT");
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != host.npos) {
    throw refuse("is not HOST:PORT; an IPv6 address goes in brackets");
  }
  if (host.empty() || host.find_first_of(" \t[]\n") != host.npos) throw refuse("names no host");
  constexpr int kLargestPort = 65535;
  HostPort address{std::string(host)};
  if (!ParseNumber(text.substr(colon + 1), &address.port) || address.port < 0 ||
      address.port > kLargestPort) {
    throw refuse("has no port from 0 to 65535");
  }
  return address;
}

std::string ToString(const HostPort& address) {
  if (address.host.find(':') == address.host.npos) {
    return fmt::format("{}:{}", address.host, address.port);
  }
  return fmt::format("[{}]:{}", address.host, address.port);
}

bool IsLoopback(const std::string& host) {
  if (host == "localhost") return true;
  in_addr v4 = {};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == 127;
  in6_addr v6 = {};
  if (inet_pton(AF_INET6, host.c_str(), &v6) != 1) return false;
  return IN6_IS_ADDR_LOOPBACK(&v6) || (IN6_IS_ADDR_V4MAPPED(&v6) && v6.s6_addr[12] == 127);
}

}  // namespace loopgrid
