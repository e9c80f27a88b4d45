#include "apps/online/source/pipe_source.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/online/source/line_inlet.h"
#include "apps/online/source/start_check.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

using Buffer = std::array<char, std::size_t{1} << 16>;

[[noreturn]] void FailToRead(const std::string& name, int error) {
  throw Error(ErrorCode::kInput, name + ": cannot read: " + std::generic_category().message(error));
}

}  // namespace

PipeSource::PipeSource(int descriptor, std::string name)
    : descriptor_(descriptor), name_(std::move(name)) {
  const int flags = fcntl(descriptor_, F_GETFL);
  if (flags < 0) FailToRead(name_, errno);
  if ((flags & O_ACCMODE) == O_WRONLY) FailToRead(name_, EBADF);
  struct stat status = {};
  if (fstat(descriptor_, &status) == 0 && S_ISDIR(status.st_mode)) FailToRead(name_, EISDIR);
}

void PipeSource::Run(LineQueue* queue) {
  LineInlet inlet(queue);
  StartCheck check(name_);
  const auto buffer = std::make_unique<Buffer>();
  while (WaitForBytes()) {
    const ssize_t count = read(descriptor_, buffer->data(), buffer->size());
    if (count == 0) break;
    if (count < 0) {
      if (errno == EINTR || errno == EAGAIN) continue;
      FailToRead(name_, errno);
    }
    const std::string_view bytes(buffer->data(), static_cast<std::size_t>(count));
    check.Look(bytes);
    if (!inlet.Add(bytes)) return;
  }
  inlet.Finish();
}

/// False if Stop() was called.
bool PipeSource::WaitForBytes() const {
  std::array<pollfd, 2> waiting = {pollfd{descriptor_, POLLIN, 0},
                                   pollfd{wake_up_.descriptor(), POLLIN, 0}};
  while (poll(waiting.data(), waiting.size(), -1) < 0) {
    if (errno != EINTR) FailToRead(name_, errno);
  }
  return waiting[1].revents == 0;
}

}  // namespace loopgrid
