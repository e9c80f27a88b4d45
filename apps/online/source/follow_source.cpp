#include "apps/online/source/follow_source.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr int kLookMilliseconds = 50;

[[noreturn]] void FailToFollow(const std::string& path, const std::string& problem) {
  throw Error(ErrorCode::kInput, path + ": " + problem);
}

std::string SystemReason() { return std::generic_category().message(errno); }

struct stat StatusOf(const Descriptor& file, const std::string& path) {
  struct stat status = {};
  if (fstat(file.get(), &status) != 0) FailToFollow(path, "cannot read: " + SystemReason());
  return status;
}

/// None if there is no such file.
Descriptor OpenIfThere(const std::string& path) {
  // O_NONBLOCK: it may be a pipe, and open() would wait until somebody writes to it.
  Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file && errno == ENOENT) return file;
  if (!file) FailToFollow(path, "cannot open: " + SystemReason());
  if (!S_ISREG(StatusOf(file, path).st_mode))
    FailToFollow(path, "only a regular file can be followed");
  return file;
}

/// Waits until a file is written to. Some file systems, such as those over a network, do not report
/// it.
class FileWatch {
 public:
  FileWatch() : inotify_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {}

  /// Watches this file from now on, and stops watching the one before.
  void Watch(const Descriptor& file) {
    if (watch_ >= 0) inotify_rm_watch(inotify_.get(), watch_);
    // Its name may already belong to another file, so the descriptor is used.
    const std::string path = "/proc/self/fd/" + std::to_string(file.get());
    watch_ = inotify_add_watch(inotify_.get(), path.c_str(), IN_MODIFY);
  }

  /// Waits for a while, or until the file is written to, or for `wake_up`.
  void Wait(const WakeUp& wake_up) const {
    std::array<pollfd, 2> waiting = {pollfd{wake_up.descriptor(), POLLIN, 0},
                                     pollfd{inotify_.get(), POLLIN, 0}};
    poll(waiting.data(), waiting.size(), kLookMilliseconds);
    std::array<char, 4096> events;
    while (read(inotify_.get(), events.data(), events.size()) > 0) {
    }
  }

 private:
  Descriptor inotify_;
  int watch_ = -1;
};

}  // namespace

FollowSource::FollowSource(std::string path) : path_(std::move(path)), check_(path_) {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!std::filesystem::is_directory(folder.empty() ? "." : folder, error)) {
    FailToFollow(path_, "there is no such folder");
  }
  file_ = OpenIfThere(path_);
}

void FollowSource::Run(LineQueue* queue) {
  LineInlet inlet(queue);
  FileWatch watch;
  if (file_) watch.Watch(file_);
  while (ReadToEnd(&inlet)) {
    if (HasShrunk()) {
      inlet.Finish();
      offset_ = 0;
      counters_.Count(&SourceCounters::truncations);
      continue;
    }
    Descriptor successor = OpenSuccessor();
    if (!successor) {
      watch.Wait(wake_up_);
      continue;
    }
    if (file_) {
      // The old file may have grown after it was read and before the new one took its name.
      if (!ReadToEnd(&inlet)) break;
      inlet.Finish();
      counters_.Count(&SourceCounters::rotations);
    }
    file_ = std::move(successor);
    offset_ = 0;
    watch.Watch(file_);
  }
  inlet.Finish();
}

/// False if it is time to end.
bool FollowSource::ReadToEnd(LineInlet* inlet) {
  std::array<char, std::size_t{1} << 16> buffer;
  while (!wake_up_.signalled()) {
    if (!file_) return true;
    const ssize_t count = pread(file_.get(), buffer.data(), buffer.size(), offset_);
    if (count < 0) FailToFollow(path_, "cannot read: " + SystemReason());
    if (count == 0) return true;
    offset_ += count;
    const std::string_view bytes(buffer.data(), static_cast<std::size_t>(count));
    check_.Look(bytes);
    if (!inlet->Add(bytes)) return false;
  }
  return false;
}

bool FollowSource::HasShrunk() const { return file_ && StatusOf(file_, path_).st_size < offset_; }

/// The file that has the name now, if it is not the open one. A new file is ignored while it is
/// empty, because the writer may still write to the old one.
Descriptor FollowSource::OpenSuccessor() const {
  struct stat named = {};
  if (stat(path_.c_str(), &named) != 0) return {};
  if (file_) {
    const struct stat open_one = StatusOf(file_, path_);
    const bool same = named.st_dev == open_one.st_dev && named.st_ino == open_one.st_ino;
    if (same || named.st_size == 0) return {};
  }
  return OpenIfThere(path_);
}

}  // namespace loopgrid
