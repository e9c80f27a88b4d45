// Any bytes as a file of relations: an Error, or valid relations.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "backend/base/error.h"
#include "frontend/evaluation/relations_file.h"
#include "tests/support/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const loopgrid::test_support::MemoryFile file({reinterpret_cast<const char*>(data), size});
  try {
    for (const auto& relation : loopgrid::ReadRelationsFile(file.path())) {
      const bool sound = std::isfinite(relation.t1) && std::isfinite(relation.t2) &&
                         relation.T_1_2.coordinates().allFinite();
      if (!sound) std::abort();
    }
  } catch (const loopgrid::Error& error) {
    if (std::string_view(error.what()).find(file.path() + ":") != 0) std::abort();
  }
  return 0;
}
