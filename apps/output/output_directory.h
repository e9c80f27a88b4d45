#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "apps/output/folder_lock.h"

namespace loopgrid {

/// The folder that a run leaves its files in: all of them or none. Files are written to a hidden
/// folder inside it and move to their places together, in Commit(). Without Commit() nothing stays
/// behind, not even the folder itself if it was not there before. From Prepare() on the folder is
/// locked against other processes.
class OutputDirectory {
 public:
  /// For the files `names` in `directory`. Touches nothing yet.
  OutputDirectory(const std::string& directory, std::vector<std::string> names);
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

  /// Makes the folder (and its parents) where missing, removes what a killed process has left
  /// unfinished in it, and finds out whether the files can be made. Throws Error (kOutput) if not,
  /// or if another process uses the folder.
  void Prepare();

  /// Calls `write` with the path to write the file `name` to for now. Errors name its final place.
  void Write(const std::string& name, const std::function<void(const std::string& path)>& write);

  /// The same for a file that is ready in memory.
  void Write(const std::string& name, std::string_view content);

  /// The file `name` is not made this time. One that an earlier run left goes with Commit().
  void LeaveOut(const std::string& name);

  /// Moves every file to its place. Throws Error (kOutput) if one is missing or cannot be moved;
  /// the folder then holds what it held before.
  void Commit();

  /// Removes what is not committed. Any thread may call it, also during Prepare() or Commit(),
  /// which then come first. Nothing can be written afterwards.
  void Discard() noexcept;

 private:
  void CreateDirectories();
  void RemoveLeftovers() const;
  void CheckPlaces() const;
  void MoveIntoPlace(const std::string& name, const std::filesystem::path& place);

  std::filesystem::path directory_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> created_;  // folders that were not there, outermost first
  std::vector<std::string> names_;
  std::set<std::string> left_out_;
  FolderLock lock_;
  std::mutex mutex_;
  bool done_ = false;
};

}  // namespace loopgrid
