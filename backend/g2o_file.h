#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "backend/pose_graph.h"

namespace loopgrid {

/// A pose graph and the names its nodes have in a file.
struct G2oGraph {
  PoseGraph<SE2> graph;
  std::vector<std::int64_t> ids;  ///< of the vertices, one a node
};

/// Reads a g2o file, plain or gzipped: VERTEX_SE2, EDGE_SE2 and FIX lines in any order; empty lines
/// and lines that begin with # are passed over. Nodes are numbered in the order of the file.
/// Throws Error (kInput) beginning `file:line: ` at a line that is not understood, is malformed or
/// cut, holds a number that is not finite or an information matrix that is not positive
/// semi-definite, names a vertex twice or one that the file does not have.
G2oGraph ReadG2o(const std::string& path);

/// The text of a g2o file: vertices, fixed ones, edges, numbers with all their digits. `ids` may be
/// empty (the nodes' indices are used). What the format has no place for, Constraint::robust, is
/// left out.
std::string FormatG2o(const PoseGraph<SE2>& graph, const std::vector<std::int64_t>& ids = {});

/// Writes it, whole or not at all. Throws Error (kOutput).
void WriteG2o(const std::string& path, const PoseGraph<SE2>& graph,
              const std::vector<std::int64_t>& ids = {});

}  // namespace loopgrid
