#include "apps/output/peak_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace loopgrid {

double PeakMemoryMb() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

double MemoryMb() {
  std::ifstream pages("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  pages >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace loopgrid
