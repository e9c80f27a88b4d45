#pragma once

#include <filesystem>

namespace loopgrid {

/// What stands at a place before another file replaces it, kept under a second name so that it can
/// be put back. Only one of PutBack() and Forget() may be called.
class KeptFile {
 public:
  /// Keeps the file at `place`, if there is one, as `second_name`, which is not taken and on the
  /// same file system. The file stays at its place where the file system knows hard links, else it
  /// is moved. Throws Error (kOutput) if the place is a folder, or the file cannot be kept.
  KeptFile(std::filesystem::path place, std::filesystem::path second_name);

  /// Leaves the place as it was, whatever is there now.
  void PutBack() noexcept;

  /// Removes the kept file: its successor is in place.
  void Forget() noexcept;

 private:
  std::filesystem::path place_;
  std::filesystem::path second_name_;
  bool is_kept_ = false;  // there was a file
};

}  // namespace loopgrid
