#pragma once

#include <string>
#include <string_view>

#include "apps/net/descriptor.h"
#include "apps/net/host_port.h"

namespace loopgrid {

/// The receiver of a log that is played. Every failure is an Error (kOutput).
class ReplayOutput {
 public:
  /// Standard output.
  ReplayOutput();

  /// A TCP connection to that address.
  explicit ReplayOutput(const HostPort& address);

  /// Waits until the receiver, or the system's buffer, has taken all bytes.
  void Write(std::string_view bytes) const;

  /// Closes this side of a connection and waits until the receiver has closed the other side. Only
  /// then is it certain that the receiver has not refused the bytes.
  void Finish() const;

 private:
  [[noreturn]] void Fail(const std::string& problem) const;

  std::string name_;
  Descriptor socket_;
  int descriptor_;
};

}  // namespace loopgrid
