#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace loopgrid {

/// Has the system notice within half a minute when the other end of a TCP connection is gone
/// without a word: its power, or the cable.
void KeepAlive(int socket);

/// Takes what a socket has received.
class SocketReader {
 public:
  enum class Outcome { kBytes, kNothing, kEnd };

  /// Never waits. kNothing: nothing is there now. kEnd: the other end sends no more.
  Outcome Read(int socket);

  /// After kBytes: what was received, until the next call.
  std::string_view bytes() const { return {buffer_.data(), size_}; }

  /// After kEnd: why, if it was not in good order.
  const std::string& problem() const { return problem_; }

 private:
  std::array<char, std::size_t{1} << 16> buffer_;
  std::size_t size_ = 0;
  std::string problem_;
};

}  // namespace loopgrid
