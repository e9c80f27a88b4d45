#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "apps/net/descriptor.h"

namespace loopgrid::test_support {

inline sockaddr_in LoopbackAddress(int port) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// One end of a TCP connection on loopback, by plain system calls, for tests of clients that behave
/// badly.
class Socket {
 public:
  explicit Socket(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

  /// `receive_buffer`: its size in bytes; 0: the system decides.
  static Socket ConnectTo(int port, int receive_buffer = 0) {
    Socket result(Descriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)));
    if (receive_buffer > 0) {
      setsockopt(result.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    const sockaddr_in address = LoopbackAddress(port);
    if (connect(result.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("cannot connect to port " + std::to_string(port));
    }
    return result;
  }

  int get() const { return descriptor_.get(); }

  /// False if the other end has closed the connection.
  bool Send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = send(get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }

  /// Sends what it can without waiting; bytes sent.
  std::size_t SendWithoutWaiting(std::string_view bytes) const {
    const ssize_t count = send(get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }

  /// Waits for bytes and returns them; none at the end, or if none arrive in time.
  std::string Receive() const {
    std::array<char, 4096> bytes;
    pollfd waiting = {get(), POLLIN, 0};
    if (poll(&waiting, 1, 60'000) <= 0) return "";
    const ssize_t count = recv(get(), bytes.data(), bytes.size(), 0);
    return std::string(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }

  /// Closes this side only: sends no more, but can still receive.
  void CloseHalf() const { shutdown(get(), SHUT_WR); }

  /// Resets the connection instead of closing it.
  void Reset() {
    const linger at_once = {1, 0};
    setsockopt(get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    descriptor_ = Descriptor();
  }

  /// Waits until the other end has closed the connection; false if it does not.
  bool WaitForEnd() const {
    std::array<char, 4096> ignored;
    pollfd waiting = {get(), POLLIN, 0};
    while (poll(&waiting, 1, 60'000) > 0) {
      if (recv(get(), ignored.data(), ignored.size(), 0) <= 0) return true;
    }
    return false;
  }

 private:
  Descriptor descriptor_;
};

/// A port on loopback that listens.
class Listener {
 public:
  explicit Listener(int port = 0) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address = LoopbackAddress(port);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_.get(), generic, size) != 0 || listen(socket_.get(), 100) != 0 ||
        getsockname(socket_.get(), generic, &size) != 0) {
      throw std::runtime_error("cannot listen");
    }
    port_ = ntohs(address.sin_port);
  }

  int port() const { return port_; }

  Socket Accept() const {
    pollfd waiting = {socket_.get(), POLLIN, 0};
    if (poll(&waiting, 1, 60'000) <= 0) throw std::runtime_error("nobody connects");
    return Socket(Descriptor(accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC)));
  }

 private:
  Descriptor socket_;
  int port_ = 0;
};

}  // namespace loopgrid::test_support
