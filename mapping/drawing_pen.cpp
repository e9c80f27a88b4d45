// This file defines nothing else: the linker takes it only where the program defines no
// DrawingPen() of its own.
#include "mapping/pen.h"

namespace loopgrid {

const Pen& DrawingPen() { return OpenCvPen(); }

}  // namespace loopgrid
