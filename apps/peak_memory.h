#pragma once

namespace loopgrid {

/// The largest resident memory of this process so far, in 10^6 bytes.
double PeakMemoryMb();

}  // namespace loopgrid
