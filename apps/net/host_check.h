#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// Decides which `Host` headers of HTTP requests a server answers to. A web page of another site
/// can have its own name point to this machine and so read what the server tells (DNS rebinding).
/// Its requests then carry that name in `Host`.
class HostCheck {
 public:
  /// A server that only this machine reaches answers to `localhost`, to all loopback addresses, and
  /// to `name`, the host that it was told to bind to. Any other server answers to every host: it
  /// cannot know by which names other machines know it.
  HostCheck(bool is_loopback, std::string_view name);

  /// `host` is the value of the header: a name or an address, with or without a port.
  bool Accepts(std::string_view host) const;

 private:
  bool is_loopback_;
  std::string name_;  // in lower case, without brackets
};

}  // namespace loopgrid
