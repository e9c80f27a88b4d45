#pragma once

#include <filesystem>

namespace loopgrid {

/// Keeps a file under a second name before another file replaces it, so that it can be put back.
/// Only one of PutBack() and Forget() may be called.
class KeptFile {
 public:
  /// Keeps the file at `place`, if there is one, as `second_name`, a free name on the same file
  /// system. If the file system has hard links, the file also stays at its place; otherwise it is
  /// moved. Throws Error (kOutput) if the place is a folder, or the file cannot be kept.
  KeptFile(std::filesystem::path place, std::filesystem::path second_name);

  /// Restores the place to what it was.
  void PutBack() noexcept;

  /// Removes the kept file. Call this when the new file is in place.
  void Forget() noexcept;

 private:
  std::filesystem::path place_;
  std::filesystem::path second_name_;
  bool is_kept_ = false;  // there was a file
};

}  // namespace loopgrid
