#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace loopgrid {

/// Makes the system close a TCP connection within half a minute when the other machine does not
/// answer any more, because its power or its network has failed.
void KeepAlive(int socket);

/// Reads what a socket has received.
class SocketReader {
 public:
  enum class Outcome { kBytes, kNothing, kEnd };

  /// Never waits. kNothing: nothing is there now. kEnd: the other end sends no more.
  Outcome Read(int socket);

  /// After kBytes: what was received, until the next call.
  std::string_view bytes() const { return {buffer_.data(), size_}; }

  /// After kEnd: the error that ended the connection; empty if the other end has closed it.
  const std::string& problem() const { return problem_; }

 private:
  std::array<char, std::size_t{1} << 16> buffer_;
  std::size_t size_ = 0;
  std::string problem_;
};

}  // namespace loopgrid
