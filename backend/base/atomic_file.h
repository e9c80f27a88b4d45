#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// Writes a file so that either all of it or nothing appears under its name: the bytes go to a
/// temporary file in the same folder, which Commit() renames. If the target exists and is not a
/// regular file (a device, a pipe), it is written directly. Every failure, such as a full disk, is
/// an Error (kOutput) that begins `file: `.
class AtomicFile {
 public:
  /// Opens the temporary; throws if the target is a directory or its folder cannot be written.
  explicit AtomicFile(const std::string& path);

  /// Removes the temporary if Commit() has not been reached.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void Append(std::string_view bytes);

  /// Writes all bytes to the disk, so that Commit() only has to rename. Only Commit() may follow.
  void Finish();

  /// Calls Finish() if that has not been done, and gives the file its name. Nothing may follow.
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
