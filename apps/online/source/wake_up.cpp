#include "apps/online/source/wake_up.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace loopgrid {

WakeUp::WakeUp() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!descriptor_) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void WakeUp::Signal() const {
  const std::uint64_t one = 1;
  // It fails only if the count is at its limit, and then the descriptor is readable already.
  [[maybe_unused]] const auto written = write(descriptor(), &one, sizeof one);
}

bool WakeUp::signalled() const {
  pollfd waiting = {descriptor(), POLLIN, 0};
  return poll(&waiting, 1, 0) > 0;
}

}  // namespace loopgrid
