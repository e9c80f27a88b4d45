#include "backend/base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 16;

// Names of the open temporaries, for a signal handler: no locks, no allocation. A temporary that
// finds no free slot is still removed by its destructor.
constexpr int kSlots = 64;
std::array<std::atomic<const char*>, kSlots> temporaries{};
static_assert(std::atomic<const char*>::is_always_lock_free);

int Register(const char* name) {
  for (int slot = 0; slot < kSlots; ++slot) {
    const char* free_slot = nullptr;
    if (temporaries[static_cast<std::size_t>(slot)].compare_exchange_strong(free_slot, name)) {
      return slot;
    }
  }
  return -1;
}

void Unregister(int slot) {
  if (slot >= 0) temporaries[static_cast<std::size_t>(slot)] = nullptr;
}

/// A name beside `target` that no other AtomicFile has, in this process or another.
std::string TemporaryName(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  const std::filesystem::path path(target);
  std::string name = ".";
  name += path.filename().string() + ".tmp-" + std::to_string(getpid()) + "-" +
          std::to_string(counter++);
  return (path.parent_path() / name).string();
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(path) {
  struct stat status = {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    throw Error(ErrorCode::kOutput, path + ": is a directory");
  }
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) Fail("cannot open");
    return;
  }
  std::error_code ignored;
  if (exists) target_ = std::filesystem::canonical(path, ignored).string();
  if (target_.empty()) target_ = path;
  temporary_ = TemporaryName(target_);
  descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) Fail("cannot create");
  slot_ = Register(temporary_.c_str());
}

AtomicFile::~AtomicFile() { CloseAndRemove(); }

void AtomicFile::CloseAndRemove() noexcept {
  if (descriptor_ < 0) return;
  close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) unlink(temporary_.c_str());
  Unregister(slot_);
}

void AtomicFile::Fail(const std::string& doing) const {
  const int reason = errno;
  throw Error(ErrorCode::kOutput,
              path_ + ": " + doing + ": " + std::generic_category().message(reason));
}

void AtomicFile::Append(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferSize) Flush();
}

void AtomicFile::Flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) Fail("cannot write");
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void AtomicFile::Finish() {
  Flush();
  // Devices and pipes cannot be synchronised.
  if (!temporary_.empty() && fsync(descriptor_) != 0) Fail("cannot write");
  finished_ = true;
}

void AtomicFile::Commit() {
  if (!finished_) Finish();
  if (temporary_.empty()) {
    const int status = close(descriptor_);
    descriptor_ = -1;
    if (status != 0) Fail("cannot write");
    return;
  }
  if (rename(temporary_.c_str(), target_.c_str()) != 0) Fail("cannot move into place");
  close(descriptor_);
  descriptor_ = -1;
  Unregister(slot_);
}

void AtomicFile::RemoveTemporaries() noexcept {
  for (const auto& name : temporaries) {
    if (const char* path = name.load()) unlink(path);
  }
}

void WriteFileAtomically(const std::string& path, std::string_view content) {
  AtomicFile file(path);
  file.Append(content);
  file.Commit();
}

}  // namespace loopgrid
