#include "apps/output/peak_memory.h"

#include <gtest/gtest.h>

namespace loopgrid {
namespace {

TEST(PeakMemory, IsOfThisProcess) {
  EXPECT_GT(PeakMemoryMb(), 1.0);
  EXPECT_LT(PeakMemoryMb(), 1e6);
}

}  // namespace
}  // namespace loopgrid
