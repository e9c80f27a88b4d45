// loopgrid-drawing.so: the pen that draws with OpenCV.
#include "mapping/pen.h"

extern "C" {

extern const char loopgrid_module_version[];
const char loopgrid_module_version[] = LOOPGRID_VERSION;

const loopgrid::Pen* loopgrid_drawing_pen();
const loopgrid::Pen* loopgrid_drawing_pen() { return &loopgrid::OpenCvPen(); }
}
