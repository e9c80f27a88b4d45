#include "apps/peak_memory.h"

#include <sys/resource.h>

namespace loopgrid {

double PeakMemoryMb() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

}  // namespace loopgrid
