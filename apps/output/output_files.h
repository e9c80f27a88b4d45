#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "backend/base/atomic_file.h"

namespace loopgrid {

/// Files that a command leaves in places of their own: all of them or none (see AtomicFile; devices
/// and pipes are written directly). OutputDirectory is the same for files that share a folder.
class OutputFiles {
 public:
  /// Touches nothing yet. Throws Error (kUsage) if two paths mean the same file.
  explicit OutputFiles(std::vector<std::string> paths);
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  const std::vector<std::string>& paths() const { return paths_; }

  /// Finds out whether all of them can be written. Throws Error (kOutput) if not.
  void Open();

  /// The content of one of the files; nothing is to be seen of it before Commit(). Throws Error
  /// (kOutput).
  void Write(const std::string& path, std::string_view content);

  /// Gives all files their names. Throws Error (kOutput) if one cannot be written in full, and then
  /// there is none, and what stood in their places is there again.
  void Commit();

  /// Removes what is not committed. Any thread may call it, also during Open() or Commit(), which
  /// then come first; the process must end afterwards.
  void Discard() noexcept;

 private:
  std::vector<std::string> paths_;
  std::mutex mutex_;  // of files_
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

}  // namespace loopgrid
