#include "apps/output/kept_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "backend/base/error.h"

namespace loopgrid {

namespace fs = std::filesystem;

KeptFile::KeptFile(fs::path place, fs::path second_name)
    : place_(std::move(place)), second_name_(std::move(second_name)) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(place_, error);
  if (status.type() == fs::file_type::not_found) return;
  if (status.type() == fs::file_type::directory) {
    throw Error(ErrorCode::kOutput,
                place_.string() + ": is a directory, and a file of this name is to be written");
  }
  if (link(place_.c_str(), second_name_.c_str()) != 0 &&
      rename(place_.c_str(), second_name_.c_str()) != 0) {
    throw Error(ErrorCode::kOutput, place_.string() + ": cannot be replaced: " +
                                        std::generic_category().message(errno));
  }
  is_kept_ = true;
}

void KeptFile::PutBack() noexcept {
  if (!is_kept_) {
    unlink(place_.c_str());
    return;
  }
  // If the file is still at its place, rename() does nothing, and the second name is removed.
  if (rename(second_name_.c_str(), place_.c_str()) == 0) unlink(second_name_.c_str());
}

void KeptFile::Forget() noexcept {
  if (is_kept_) unlink(second_name_.c_str());
}

}  // namespace loopgrid
