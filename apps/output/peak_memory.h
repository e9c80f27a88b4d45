#pragma once

namespace loopgrid {

/// The largest resident memory of this process so far, in 10^6 bytes.
double PeakMemoryMb();

/// The resident memory of this process now, in 10^6 bytes.
double MemoryMb();

}  // namespace loopgrid
