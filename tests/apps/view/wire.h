#pragma once

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "tests/apps/online/sockets.h"

namespace loopgrid::test_support {

/// An HTTP client that sends and receives plain bytes.
class Wire {
 public:
  explicit Wire(int port) : socket_(Socket::ConnectTo(port)) {}
  Wire(int port, std::string_view request) : Wire(port) { Send(request); }

  /// `buffer`: the bytes that the system may receive before they are read, or twice as many.
  Wire(int port, std::string_view request, int buffer) : socket_(Socket::ConnectTo(port, buffer)) {
    Send(request);
  }

  Socket& socket() { return socket_; }
  bool Send(std::string_view bytes) const { return socket_.Send(bytes); }

  /// Reads until `text` has come; false if it does not, or the other end closes before.
  bool WaitFor(std::string_view text) {
    while (received_.find(text) == std::string::npos) {
      if (!ReadMore()) return false;
    }
    return true;
  }

  /// Reads until `count` bytes have arrived; false if they do not.
  bool WaitForBytes(std::size_t count) {
    while (received_.size() < count) {
      if (!ReadMore()) return false;
    }
    return true;
  }

  /// Reads until the other end closes the connection; false if it does not.
  bool WaitForEnd() {
    while (ReadMore()) continue;
    return ended_;
  }

  const std::string& received() const { return received_; }
  void Forget() { received_.clear(); }

 private:
  bool ReadMore() {
    pollfd waiting = {socket_.get(), POLLIN, 0};
    if (poll(&waiting, 1, 60'000) <= 0) return false;
    std::array<char, 65536> bytes;
    const ssize_t count = recv(socket_.get(), bytes.data(), bytes.size(), 0);
    ended_ = count <= 0;
    if (!ended_) received_.append(bytes.data(), static_cast<std::size_t>(count));
    return !ended_;
  }

  Socket socket_;
  std::string received_;
  bool ended_ = false;
};

}  // namespace loopgrid::test_support
