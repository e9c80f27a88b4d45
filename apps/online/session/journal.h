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

/// The file of the lines received so far. It is itself a CARMEN log. A session resumes from it, the
/// corrected log is made of it, and `loopgrid run` can map it. When Append() returns, the operating
/// system has the line, so the line is kept even if the process is killed. It is on the disk a
/// second later. Throws Error (kOutput) `file: ...`; the file then ends with the last line that
/// could be written completely.
class Journal {
 public:
  /// Opens the file, or makes it.
  explicit Journal(const std::string& path);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::string& path() const { return path_; }
  bool empty() const { return size_ == 0; }

  /// Calls `visit` for each line, as it was received. Throws Error (kInput) if the file cannot be
  /// read.
  void Read(const std::function<void(ReceivedLine)>& visit) const;

  /// Whether the last line has no line end, because the stream or the process ended within it.
  bool has_open_end() const { return !open_end_.empty(); }

  /// Adds a line. If the last line has no end, it first loses its last field, which may be cut
  /// short, and gets a line end.
  void Append(const ReceivedLine& line);

  /// Whether the last line, which has no end, may be the beginning of `line`.
  bool IsContinuedBy(const ReceivedLine& line) const;

  /// Replaces the last line, which is the beginning of `line`, by `line`.
  void Complete(const ReceivedLine& line);

  /// Writes everything to the disk now.
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

  mutable std::mutex mutex_;  // guards the members below, which the syncing thread uses too
  std::condition_variable wake_;
  bool unsynced_ = false;
  bool closing_ = false;
  std::string problem_;
  std::thread syncing_;
};

/// The bytes in the file that are read as this line, without its end.
std::string JournalText(const ReceivedLine& line);

/// Makes a comment of a first line that would make the file look gzipped or binary.
void KeepReadable(ReceivedLine* first);

}  // namespace loopgrid
