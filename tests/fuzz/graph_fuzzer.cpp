// Any bytes as a graph file: nothing may crash, and a graph that is accepted is sound and comes
// back unchanged when it is written as g2o and read again.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>

#include "backend/base/error.h"
#include "backend/graph_file.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

template <typename Pose>
void RoundTrip(const GraphFile<Pose>& file) {
  Validate(file.graph);
  const std::string text = FormatGraph(file.graph, file.ids);
  const test_support::MemoryFile written(text);
  const auto again = ReadGraphOf<Pose>(written.path());
  if (FormatGraph(again.graph, again.ids) != text) std::abort();
}

}  // namespace
}  // namespace loopgrid

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace loopgrid;  // NOLINT(google-build-using-namespace)
  const test_support::MemoryFile file(
      std::string_view(reinterpret_cast<const char*>(data), size));
  AnyGraphFile read;
  try {
    read = ReadGraph(file.path());
  } catch (const Error&) {
    return 0;
  }
  std::visit([](const auto& found) { RoundTrip(found); }, read);
  return 0;
}
