#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// A file that appears under its name whole or not at all: it is written to a temporary beside the
/// target, which Commit() moves into place. An existing target that is no regular file (a device, a
/// pipe) is written directly. Every failure, a full disk included, is an Error (kOutput) that
/// begins `file: `.
class AtomicFile {
 public:
  /// Opens the temporary; throws if the target is a directory or its folder cannot be written.
  explicit AtomicFile(const std::string& path);

  /// Removes the temporary if Commit() has not been reached.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void Append(std::string_view bytes);

  /// Writes everything through to the disk, after which little is left that can fail. Only Commit()
  /// may follow.
  void Finish();

  /// Finishes, if that is not done, and gives the file its name. Nothing may follow.
  void Commit();

  const std::string& path() const { return path_; }

  /// Removes the temporaries of all AtomicFiles in the process. Safe in a signal handler; the
  /// process must end afterwards.
  static void RemoveTemporaries() noexcept;

 private:
  void Flush();
  [[noreturn]] void Fail(const std::string& doing) const;
  void CloseAndRemove() noexcept;

  std::string path_;
  std::string target_;     // what the path means once symbolic links are followed
  std::string temporary_;  // empty when writing directly
  int descriptor_ = -1;
  bool finished_ = false;
  int slot_ = -1;  // in the list that RemoveTemporaries() walks
  std::string buffer_;
};

/// Writes a file whole or not at all. Throws Error (kOutput) as AtomicFile does.
void WriteFileAtomically(const std::string& path, std::string_view content);

}  // namespace loopgrid
