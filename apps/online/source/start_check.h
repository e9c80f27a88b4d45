#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace loopgrid {

/// Checks whether the beginning of a stream can be a log of lines. The stream may arrive in pieces
/// of any size.
class StartCheck {
 public:
  /// `name` is the name of the stream for messages.
  explicit StartCheck(std::string name) : name_(std::move(name)) {}

  /// Takes the next bytes. Throws Error (kInput) if the stream turns out to be gzipped or binary.
  void Look(std::string_view bytes);

 private:
  std::string name_;
  std::size_t seen_ = 0;  // bytes
  bool maybe_gzip_ = false;
};

}  // namespace loopgrid
