#include "apps/output/output_directory.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "apps/output/kept_file.h"
#include "apps/output/session_names.h"
#include "backend/base/atomic_file.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStagingPrefix = ".loopgrid-unfinished-";

[[noreturn]] void FailToWrite(const fs::path& path, const std::string& what) {
  throw Error(ErrorCode::kOutput, fmt::format("{}: {}", path.string(), what));
}

[[noreturn]] void FailToWrite(const fs::path& path, const std::error_code& error) {
  FailToWrite(path, error.message());
}

}  // namespace

OutputDirectory::OutputDirectory(const std::string& directory, std::vector<std::string> names)
    : directory_(directory), names_(std::move(names)) {}

OutputDirectory::~OutputDirectory() { Discard(); }

void OutputDirectory::Prepare() {
  const std::lock_guard lock(mutex_);
  CreateDirectories();
  if (lock_.Acquire(directory_)) RemoveLeftovers();
  CheckPlaces();
  std::string pattern = (directory_ / kStagingPrefix).string() + "XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr) {
    FailToWrite(directory_, std::error_code(errno, std::generic_category()));
  }
  staging_ = pattern;
}

void OutputDirectory::CreateDirectories() {
  if (directory_.empty()) FailToWrite("--out", "the name is empty");
  fs::path path;
  for (const fs::path& part : directory_) {
    path /= part;
    std::error_code error;
    if (fs::is_directory(path, error)) continue;
    if (fs::exists(path, error)) FailToWrite(path, "is not a directory");
    if (!fs::create_directory(path, error)) FailToWrite(path, error);
    created_.push_back(path);
  }
}

/// Needs the lock: no other process is using the folder, so unfinished files in it are left over.
void OutputDirectory::RemoveLeftovers() const {
  std::vector<std::string> ours = names_;
  ours.insert(ours.end(), {kJournalName, kSessionName});
  const auto is_leftover = [&ours](const std::string& name) {
    return name.starts_with(kStagingPrefix) ||
           std::any_of(ours.begin(), ours.end(), [&name](const std::string& file) {
             return name.starts_with("." + file + ".tmp-");
           });
  };
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_, ignored)) {
    if (is_leftover(entry.path().filename())) leftovers.push_back(entry.path());
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, ignored);
}

void OutputDirectory::CheckPlaces() const {
  for (const std::string& name : names_) {
    std::error_code error;
    if (fs::is_directory(directory_ / name, error)) {
      FailToWrite(directory_ / name, "is a directory, and a file of this name is to be written");
    }
  }
}

void OutputDirectory::Write(const std::string& name,
                            const std::function<void(const std::string& path)>& write) {
  const std::string path = (staging_ / name).string();
  try {
    write(path);
  } catch (const Error& error) {
    const std::string_view message = error.what();
    if (!message.starts_with(path)) throw;
    throw Error(error.code(), (directory_ / name).string().append(message.substr(path.size())));
  }
}

void OutputDirectory::Write(const std::string& name, std::string_view content) {
  Write(name, [content](const std::string& path) { WriteFileAtomically(path, content); });
}

void OutputDirectory::LeaveOut(const std::string& name) { left_out_.insert(name); }

void OutputDirectory::Commit() {
  const std::lock_guard lock(mutex_);
  std::error_code error;
  for (const std::string& name : names_) {
    if (left_out_.contains(name) || fs::is_regular_file(staging_ / name, error)) continue;
    FailToWrite(directory_ / name, "was not written");
  }
  const fs::path old = staging_ / "old";
  if (!fs::create_directory(old, error)) FailToWrite(directory_, error);
  std::vector<KeptFile> kept;
  try {
    for (const std::string& name : names_) {
      kept.emplace_back(directory_ / name, old / name);
      MoveIntoPlace(name, directory_ / name);
    }
  } catch (...) {
    for (auto file = kept.rbegin(); file != kept.rend(); ++file) file->PutBack();
    throw;
  }
  fs::remove_all(staging_, error);
  done_ = true;
}

void OutputDirectory::MoveIntoPlace(const std::string& name, const fs::path& place) {
  std::error_code error;
  if (left_out_.contains(name)) {
    fs::remove(place, error);
  } else {
    fs::rename(staging_ / name, place, error);
  }
  if (error) FailToWrite(place, error);
}

void OutputDirectory::Discard() noexcept {
  const std::lock_guard lock(mutex_);
  if (std::exchange(done_, true)) return;
  std::error_code ignored;
  // Another thread may still be writing there, so a pass may miss files. Then the next one finds
  // them.
  for (int pass = 0; pass < 10 && !staging_.empty() && fs::exists(staging_, ignored); ++pass) {
    fs::remove_all(staging_, ignored);
  }
  // Removes empty folders only.
  for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) {
    fs::remove(*folder, ignored);
  }
}

}  // namespace loopgrid
