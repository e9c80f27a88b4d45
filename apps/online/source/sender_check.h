#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// Looks at the first bytes of a connection for what is certainly no log: HTTP, gzip data, TLS. Any
/// web page can make the browser of somebody who reads it send HTTP to an address on this machine,
/// with lines of the page's choice in it. Nothing is passed on until the first bytes are judged.
class SenderCheck {
 public:
  /// Takes the next bytes of the connection. Returns those that may be passed on: none while it
  /// cannot be told yet, then also the ones that were held back, none if the sender is refused.
  /// They are valid until the next call.
  std::string_view Pass(std::string_view bytes);

  /// The connection has ended: the bytes that are still held back, which are harmless.
  std::string_view Rest();

  /// Whether bytes are held back.
  bool holds_bytes() const { return !judged_ && !held_.empty(); }

  /// Why the sender is refused; empty if it is not.
  std::string_view problem() const { return problem_; }

 private:
  std::string held_;  // while it cannot be told yet
  bool judged_ = false;
  std::string_view problem_;
};

}  // namespace loopgrid
