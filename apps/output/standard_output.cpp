#include "apps/output/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "backend/base/error.h"

namespace loopgrid {

void PrintToStandardOutput(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) == EOF) {
    throw Error(ErrorCode::kOutput, std::string("standard output: ") + std::strerror(errno));
  }
}

}  // namespace loopgrid
