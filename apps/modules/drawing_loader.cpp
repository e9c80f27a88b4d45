// The program's DrawingPen(): OpenCV is loaded when a picture is drawn.
#include <stdexcept>

#include "apps/modules/module.h"
#include "backend/base/error.h"
#include "mapping/pen.h"

namespace loopgrid {
namespace {

const Pen& LoadPen() {
  try {
    using PenFunction = const Pen* (*)();
    void* function =
        LoadFromModule("loopgrid-drawing.so", "loopgrid_drawing_pen", "draws the pictures");
    return *reinterpret_cast<PenFunction>(function)();
  } catch (const std::runtime_error& error) {
    throw Error(ErrorCode::kOutput, error.what());
  }
}

}  // namespace

const Pen& DrawingPen() {
  static const Pen& pen = LoadPen();
  return pen;
}

}  // namespace loopgrid
