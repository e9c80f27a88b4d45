#pragma once

#include <string>
#include <string_view>

#include "apps/net/descriptor.h"
#include "apps/net/host_port.h"

namespace loopgrid {

/// Where a log is played to. Whatever goes wrong is an Error (kOutput).
class ReplayOutput {
 public:
  /// Standard output.
  ReplayOutput();

  /// A TCP connection to that address.
  explicit ReplayOutput(const HostPort& address);

  /// Waits until the other side, or the system for it, has taken all of it.
  void Write(std::string_view bytes) const;

  /// Says that this was all. On a connection, waits until the other side has closed it too: only
  /// then is it certain that the bytes have not been turned away.
  void Finish() const;

 private:
  [[noreturn]] void Fail(const std::string& problem) const;

  std::string name_;
  Descriptor socket_;
  int descriptor_;
};

}  // namespace loopgrid
