#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "backend/base/error.h"
#include "backend/graph/pose_graph.h"

namespace loopgrid {

/// The names that nodes and landmarks have in a file, one each; no name is used twice. Where a list
/// is empty, nodes are named by their index and landmarks by theirs plus the number of nodes.
struct GraphIds {
  std::vector<std::int64_t> nodes;
  std::vector<std::int64_t> landmarks;
};

/// What a graph file holds.
template <typename Pose>
struct GraphFile {
  PoseGraph<Pose> graph;
  GraphIds ids;
};

using AnyGraphFile = std::variant<GraphFile<SE2>, GraphFile<SE3>>;

struct GraphReadOptions {
  /// Instead of refusing the file, pass over lines with an unknown tag, and replace an information
  /// matrix that has negative eigenvalues by the nearest one that has not.
  bool lenient = false;
};

/// What was accepted although it may be a mistake.
struct GraphNotes {
  struct Kind {
    static constexpr std::size_t kMostMessages = 3;

    std::int64_t count = 0;
    std::vector<std::string> messages;  ///< the first few, beginning `file:line: `
  };
  Kind data_lines;                 ///< lines without poses or edges (IsG2oData), passed over
  Kind unknown_tags;               ///< lines passed over in lenient reading
  Kind indefinite_information;     ///< matrices replaced in lenient reading
  Kind normalized_quaternions;     ///< whose length is not 1, even up to six digits
  std::int64_t guessed_nodes = 0;  ///< the file has edges only: poses from a spanning tree
};

/// Reads a graph file, g2o or TORO, 2D or 3D as its tags say, plain or gzipped: lines in any order;
/// empty lines and lines that begin with # are passed over. Nodes and landmarks are numbered in the
/// order of the file; in a file without vertices in the order of their ids, and the first guess is
/// a spanning tree's. Tags and fields: g2o_format.h, toro_format.h; `FIX id ...` in both. Lines of
/// data that g2o keeps beside the graph are passed over.
/// Throws Error (kInput) beginning `file:line: ` at a line that is not understood, is malformed or
/// cut, holds a number that is not finite, a quaternion of length zero or an information matrix
/// that is not positive semi-definite (see kInformationRounding), names a vertex twice or one that
/// the file does not have, fixes a landmark, or is 3D in a 2D file or the other way round.
AnyGraphFile ReadGraph(const std::string& path, const GraphReadOptions& options = {},
                       GraphNotes* notes = nullptr);

/// Reads a file that has to be of one kind, SE2 or SE3. Throws Error (kInput) if it is not.
template <typename Pose>
GraphFile<Pose> ReadGraphOf(const std::string& path, const GraphReadOptions& options = {},
                            GraphNotes* notes = nullptr) {
  AnyGraphFile file = ReadGraph(path, options, notes);
  if (auto* found = std::get_if<GraphFile<Pose>>(&file)) return std::move(*found);
  constexpr const char* kName = Pose::kDof == 3 ? "2D" : "3D";
  throw Error(ErrorCode::kInput, path + ": not a " + kName + " graph");
}

enum class GraphFormat { kG2o, kToro };

/// The format in which a file of this name is written: TORO for `.graph` and `.toro`, g2o for all
/// other names. A `.gz` at the end is ignored.
GraphFormat GraphFormatOf(const std::string& path);

/// The text of a graph file: vertices, fixed vertices, edges; numbers with all their digits. The
/// formats cannot say which constraints are robust, so that is left out. Throws Error (kUsage) for
/// landmarks in TORO.
template <typename Pose>
std::string FormatGraph(const PoseGraph<Pose>& graph, const GraphIds& ids = {},
                        GraphFormat format = GraphFormat::kG2o);

/// Writes that text to a file in the format that its name asks for, gzipped if the name ends in
/// `.gz`. Writes the whole file or nothing. Throws Error (kOutput), also (`file: `) for landmarks
/// in TORO.
template <typename Pose>
void WriteGraph(const std::string& path, const PoseGraph<Pose>& graph, const GraphIds& ids = {});

}  // namespace loopgrid
