#include "apps/output/output_files.h"

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include "apps/output/kept_file.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

void RequireDifferent(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> places;
  for (const std::string& path : paths) {
    std::error_code error;
    std::filesystem::path place = std::filesystem::weakly_canonical(path, error);
    if (error) place = path;
    if (places.insert(std::filesystem::absolute(place, error)).second) continue;
    throw Error(ErrorCode::kUsage, path + ": two different outputs would go to this file");
  }
}

/// False for devices and pipes, which are written directly.
bool IsReplaced(const std::string& path) {
  std::error_code ignored;
  return !std::filesystem::is_other(path, ignored);
}

/// Keeps the file that the path leads to, following links.
KeptFile Keep(const std::string& path) {
  std::error_code error;
  std::filesystem::path place = std::filesystem::canonical(path, error);
  if (error) place = path;
  std::filesystem::path second_name = place.parent_path() / ".";
  second_name += place.filename().string() + ".old-" + std::to_string(getpid());
  return {place, second_name};
}

}  // namespace

OutputFiles::OutputFiles(std::vector<std::string> paths) : paths_(std::move(paths)) {
  RequireDifferent(paths_);
}

OutputFiles::~OutputFiles() {
  const std::lock_guard lock(mutex_);
  files_.clear();
}

void OutputFiles::Open() {
  const std::lock_guard lock(mutex_);
  for (const std::string& path : paths_) files_.push_back(std::make_unique<AtomicFile>(path));
}

void OutputFiles::Write(const std::string& path, std::string_view content) {
  const auto place = std::find(paths_.begin(), paths_.end(), path);
  files_[static_cast<std::size_t>(place - paths_.begin())]->Append(content);
}

void OutputFiles::Commit() {
  const std::lock_guard lock(mutex_);
  for (const auto& file : files_) file->Finish();
  std::vector<KeptFile> kept;
  try {
    for (const auto& file : files_) {
      if (IsReplaced(file->path())) kept.push_back(Keep(file->path()));
      file->Commit();
    }
  } catch (...) {
    for (auto file = kept.rbegin(); file != kept.rend(); ++file) file->PutBack();
    throw;
  }
  for (KeptFile& file : kept) file.Forget();
}

void OutputFiles::Discard() noexcept {
  const std::lock_guard lock(mutex_);
  AtomicFile::RemoveTemporaries();
}

}  // namespace loopgrid
