#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace loopgrid {

/// Looks at the beginning of a stream for what cannot be a log of lines. The stream may arrive in
/// pieces of any size.
class StartCheck {
 public:
  /// `name` is the stream's, for the message.
  explicit StartCheck(std::string name) : name_(std::move(name)) {}

  /// Takes the next bytes. Throws Error (kInput) if the stream turns out to be gzipped or binary.
  void Look(std::string_view bytes);

 private:
  std::string name_;
  std::size_t seen_ = 0;  // bytes
  bool maybe_gzip_ = false;
};

}  // namespace loopgrid
