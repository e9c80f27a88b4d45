#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// Refuses connections that begin with HTTP, gzip data or TLS, which cannot be a log. Any web page
/// can make a browser on this machine send HTTP to an address on this machine, with any lines in
/// it. No bytes are passed on before the first ones are checked.
class SenderCheck {
 public:
  /// Takes the next bytes of the connection. Returns the bytes that may be passed on. While more
  /// bytes are needed to decide, these are none, and the bytes are held back. If the sender is
  /// refused, none. They are valid until the next call.
  std::string_view Pass(std::string_view bytes);

  /// Call at the end of the connection: returns the bytes that are still held back. They did not
  /// show a problem.
  std::string_view Rest();

  /// Whether bytes are held back.
  bool holds_bytes() const { return !judged_ && !held_.empty(); }

  /// Why the sender is refused; empty if it is not.
  std::string_view problem() const { return problem_; }

 private:
  std::string held_;  // bytes held back until the check is decided
  bool judged_ = false;
  std::string_view problem_;
};

}  // namespace loopgrid
