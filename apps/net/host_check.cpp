#include "apps/net/host_check.h"

#include <cctype>

#include "apps/net/host_port.h"

namespace loopgrid {
namespace {

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// "Localhost:8080" -> "localhost", "[::1]:8080" -> "::1".
std::string NameOf(std::string_view host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.rfind(':');
  if (colon != host.npos && (bracket == host.npos || colon > bracket)) host = host.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return LowerCase(host);
}

}  // namespace

HostCheck::HostCheck(bool is_loopback, std::string_view name)
    : is_loopback_(is_loopback), name_(LowerCase(name)) {}

bool HostCheck::Accepts(std::string_view host) const {
  if (!is_loopback_) return true;
  const std::string name = NameOf(host);
  return !name.empty() && (name == name_ || IsLoopback(name));
}

}  // namespace loopgrid
