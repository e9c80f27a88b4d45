#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "backend/base/atomic_file.h"

namespace loopgrid {

/// Files of a command at any places. Writes all of them or none (see AtomicFile). Devices and pipes
/// are written directly. For files in one folder see OutputDirectory.
class OutputFiles {
 public:
  /// Writes nothing yet. Throws Error (kUsage) if two paths mean the same file.
  explicit OutputFiles(std::vector<std::string> paths);
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  const std::vector<std::string>& paths() const { return paths_; }

  /// Checks that all files can be written. Throws Error (kOutput) if not.
  void Open();

  /// Sets the content of one of the files. It is not visible before Commit(). Throws Error
  /// (kOutput).
  void Write(const std::string& path, std::string_view content);

  /// Moves all files to their places. Throws Error (kOutput) if one cannot be written completely.
  /// Then none is written, and the older files are at their places again.
  void Commit();

  /// Removes files that are not committed. Any thread may call it. If Open() or Commit() is
  /// running, it waits for them. The process must end afterwards.
  void Discard() noexcept;

 private:
  std::vector<std::string> paths_;
  std::mutex mutex_;  // of files_
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

}  // namespace loopgrid
