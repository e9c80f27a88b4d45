// This file must define nothing else. The linker takes a file from a library only if it needs a
// symbol of it. So a program that defines its own DrawingPen() does not link this one.
#include "mapping/pen.h"

namespace loopgrid {

const Pen& DrawingPen() { return OpenCvPen(); }

}  // namespace loopgrid
