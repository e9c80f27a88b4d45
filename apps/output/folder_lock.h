#pragma once

#include <filesystem>

namespace loopgrid {

/// A lock on a folder that keeps other processes from writing to it. It lasts until the object is
/// destroyed or the process ends, however it ends.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Locks. Throws Error (kOutput) if another process, or another object, has the lock. Returns
  /// false, without a lock, where the file system or the permissions of the folder allow none.
  bool Acquire(const std::filesystem::path& folder);

 private:
  int descriptor_ = -1;
};

}  // namespace loopgrid
