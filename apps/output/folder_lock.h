#pragma once

#include <filesystem>

namespace loopgrid {

/// A lock on a folder that keeps other processes from writing to it. The lock ends with the object
/// or with the process, also if the process is killed.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Locks the folder. Throws Error (kOutput) if another process, or another object, has the lock.
  /// Returns false, without a lock, if the file system or the permissions of the folder do not
  /// allow one.
  bool Acquire(const std::filesystem::path& folder);

 private:
  int descriptor_ = -1;
};

}  // namespace loopgrid
