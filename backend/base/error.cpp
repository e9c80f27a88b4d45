#include "backend/base/error.h"

namespace loopgrid {

Error::Error(ErrorCode code, const std::string& message)
    : std::runtime_error(message), code_(code) {}

}  // namespace loopgrid
