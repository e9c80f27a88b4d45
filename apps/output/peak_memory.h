#pragma once

namespace loopgrid {

/// The largest resident memory of this process so far, in 10^6 bytes.
double PeakMemoryMb();

/// What it has now.
double MemoryMb();

}  // namespace loopgrid
