#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "apps/online/source/line_queue.h"

namespace loopgrid {

/// The lines received so far, in a file that is a CARMEN log itself: to go on from after a crash,
/// to correct at the end, for `loopgrid run` to map again. A line is with the operating system when
/// Append() returns, so that it survives the end of the process, however sudden; it is on the disk
/// a second later. Errors are Error (kOutput) and begin `file: `; the file then ends with the last
/// line that could be written whole.
class Journal {
 public:
  /// Opens the file, making it where it is missing.
  explicit Journal(const std::string& path);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::string& path() const { return path_; }
  bool empty() const { return size_ == 0; }

  /// Calls `visit` for each line, as it was received. Throws Error (kInput) if it cannot be read.
  void Read(const std::function<void(ReceivedLine)>& visit) const;

  /// Whether the last line has no end: the stream broke off in it, or the process while writing it.
  bool has_open_end() const { return !open_end_.empty(); }

  /// Adds a line. A last line without end gets one first, and loses the field that was cut short.
  void Append(const ReceivedLine& line);

  /// Whether the last line, which has no end, may be the beginning of `line`.
  bool IsContinuedBy(const ReceivedLine& line) const;

  /// Makes `line` of the last line, which is its beginning.
  void Complete(const ReceivedLine& line);

  /// Puts what was written on the disk, now.
  void Sync();

 private:
  void FindOpenEnd();
  void Write(std::string_view bytes);
  void CloseOpenEnd();
  void KeepSynced();
  std::string SyncProblem() const;

  std::string path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
  std::string open_end_;  // the bytes of a last line that has no end

  mutable std::mutex mutex_;  // of what follows; the syncing thread's
  std::condition_variable wake_;
  bool unsynced_ = false;
  bool closing_ = false;
  std::string problem_;
  std::thread syncing_;
};

/// The bytes that read back as this line, but for its end.
std::string JournalText(const ReceivedLine& line);

/// A first line that would make the file look packed or binary becomes a comment.
void KeepReadable(ReceivedLine* first);

}  // namespace loopgrid
