// Any bytes as a graph file, g2o or TORO: nothing may crash. A graph that is accepted is valid, and
// is the same after it is written as g2o, in 2D also as TORO, and read again.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>

#include "backend/base/error.h"
#include "backend/files/graph_file.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

template <typename Pose>
void RequireRoundTrip(const GraphFile<Pose>& file, GraphFormat format) {
  const std::string text = FormatGraph(file.graph, file.ids, format);
  const test_support::MemoryFile written(text);
  const auto again = ReadGraphOf<Pose>(written.path());
  if (FormatGraph(again.graph, again.ids, format) != text) std::abort();
}

void Check(const GraphFile<SE2>& file) {
  Validate(file.graph);
  RequireRoundTrip(file, GraphFormat::kG2o);
  if (file.graph.landmarks.empty()) RequireRoundTrip(file, GraphFormat::kToro);
}

void Check(const GraphFile<SE3>& file) {
  Validate(file.graph);
  RequireRoundTrip(file, GraphFormat::kG2o);
  if (file.graph.landmarks.empty()) (void)FormatGraph(file.graph, file.ids, GraphFormat::kToro);
}

}  // namespace
}  // namespace loopgrid

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const loopgrid::test_support::MemoryFile file(
      std::string_view(reinterpret_cast<const char*>(data), size));
  loopgrid::AnyGraphFile read;
  try {
    read = loopgrid::ReadGraph(file.path(), {.lenient = true});
  } catch (const loopgrid::Error&) {
    return 0;
  }
  std::visit([](const auto& found) { loopgrid::Check(found); }, read);
  return 0;
}
