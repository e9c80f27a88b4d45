// Any bytes as a g2o file: nothing may crash, and a graph that is accepted is sound and comes back
// unchanged when it is written and read again.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "backend/base/error.h"
#include "backend/g2o_file.h"
#include "tests/support/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const loopgrid::test_support::MemoryFile file(
      std::string_view(reinterpret_cast<const char*>(data), size));
  loopgrid::G2oGraph read;
  try {
    read = loopgrid::ReadG2o(file.path());
  } catch (const loopgrid::Error&) {
    return 0;
  }
  loopgrid::Validate(read.graph);
  const std::string text = loopgrid::FormatG2o(read.graph, read.ids);
  const loopgrid::test_support::MemoryFile written(text);
  const loopgrid::G2oGraph again = loopgrid::ReadG2o(written.path());
  if (loopgrid::FormatG2o(again.graph, again.ids) != text) std::abort();
  return 0;
}
