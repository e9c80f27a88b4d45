#include "apps/online/source/socket_reader.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>
#include <system_error>

namespace loopgrid {

void KeepAlive(int socket) {
  const auto set = [socket](int level, int option, int value) {
    setsockopt(socket, level, option, &value, sizeof value);
  };
  set(IPPROTO_TCP, TCP_KEEPIDLE, 10);  // seconds without data before the first probe
  set(IPPROTO_TCP, TCP_KEEPINTVL, 5);  // seconds between probes
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);    // unanswered probes before the connection is closed
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
}

SocketReader::Outcome SocketReader::Read(int socket) {
  size_ = 0;
  const ssize_t count = recv(socket, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (count > 0) {
    size_ = static_cast<std::size_t>(count);
    return Outcome::kBytes;
  }
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return Outcome::kNothing;
  problem_ = count < 0 ? std::generic_category().message(errno) : "";
  return Outcome::kEnd;
}

}  // namespace loopgrid
