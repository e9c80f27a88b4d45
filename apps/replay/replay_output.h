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

  /// Tells the other side of a connection that nothing more comes, and waits until it has closed
  /// the connection too: only then it is certain that it has not refused the bytes.
  void Finish() const;

 private:
  [[noreturn]] void Fail(const std::string& problem) const;

  std::string name_;
  Descriptor socket_;
  int descriptor_;
};

}  // namespace loopgrid
