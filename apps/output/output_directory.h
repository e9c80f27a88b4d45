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

/// The folder for the files of a run. Writes all files or none. Files are first written to a hidden
/// folder inside it; Commit() moves them to their places together. Without Commit() no file is
/// left, and the folder is removed if it did not exist before. From Prepare() on the folder is
/// locked against other processes.
class OutputDirectory {
 public:
  /// For the files `names` in `directory`. Writes nothing yet.
  OutputDirectory(const std::string& directory, std::vector<std::string> names);
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

  /// Makes the folder and its parents if they do not exist, removes unfinished files of a killed
  /// process, and checks that the files can be written. Throws Error (kOutput) if they cannot, or
  /// if another process uses the folder.
  void Prepare();

  /// Calls `write` with the path where the file `name` has to be written for now. Errors name its
  /// final place.
  void Write(const std::string& name, const std::function<void(const std::string& path)>& write);

  /// The same for a file that is ready in memory.
  void Write(const std::string& name, std::string_view content);

  /// The file `name` is not written this time. Commit() removes that of an earlier run.
  void LeaveOut(const std::string& name);

  /// Moves every file to its place. Throws Error (kOutput) if one is missing or cannot be moved;
  /// the folder then holds what it held before.
  void Commit();

  /// Removes files that are not committed. Any thread may call it. If Prepare() or Commit() is
  /// running, it waits for them. Nothing can be written afterwards.
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
