#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// Decides which `Host` headers of HTTP requests a server accepts. It protects against DNS
/// rebinding: a web site can let its own name lead to this machine, so that its scripts can read
/// the server's answers. The requests of such scripts have the site's name in `Host`.
class HostCheck {
 public:
  /// If the server is bound to a loopback address, it accepts `localhost`, all loopback addresses,
  /// and `name`, the host that it was asked to bind to. Any other server accepts every host,
  /// because it does not know the names that other machines use for it.
  HostCheck(bool is_loopback, std::string_view name);

  /// `host` is the value of the header: a name or an address, with or without a port.
  bool Accepts(std::string_view host) const;

 private:
  bool is_loopback_;
  std::string name_;  // in lower case, without brackets
};

}  // namespace loopgrid
