#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "backend/files/graph_file.h"

namespace loopgrid {

/// A vertex that a line names; it may be defined later in the file.
struct VertexMention {
  std::int64_t id = 0;
  std::int64_t line = 0;
};

/// A constraint, or an observation of a landmark, whose ends are known by their ids.
struct EdgeEnds {
  std::int64_t from = 0;
  std::int64_t to = 0;
  std::int64_t line = 0;
};

/// Builds a graph from the lines of a file, which may come in any order. Whatever is wrong with
/// them is an Error (kInput) that begins `file:line: `.
template <typename Pose>
class GraphBuilder {
 public:
  using Point = typename Pose::Point;

  explicit GraphBuilder(const std::string& path) : path_(path) {}

  bool empty() const { return vertices_.empty() && constraints_.empty() && observations_.empty(); }

  void AddNode(const VertexMention& name, const Pose& pose);
  void AddLandmark(const VertexMention& name, const Point& p_map);
  /// The indices that the edges contain are ignored.
  void AddConstraint(const EdgeEnds& ends, const Constraint<Pose>& constraint);
  void AddObservation(const EdgeEnds& ends, const LandmarkObservation<Pose>& observation);

  /// The pose of a sensor on a node, for observations given in the sensor's frame. Only later lines
  /// may refer to it.
  void AddSensor(const VertexMention& name, const Pose& T_node_sensor);
  const Pose& Sensor(const VertexMention& name) const;

  /// The graph, after all lines have been read. No other call may follow. Adds to `notes`.
  GraphFile<Pose> Finish(const std::vector<VertexMention>& fixed, GraphNotes* notes);

 private:
  enum class Kind { kNode, kLandmark };
  struct Vertex {
    Kind kind = Kind::kNode;
    int index = 0;
  };

  Error ErrorAt(std::int64_t line, const std::string& problem) const;
  void AddVertex(const VertexMention& name, const Vertex& vertex);
  void AddMentionedVertices();
  int Find(const VertexMention& name, Kind kind) const;
  void GuessVertices();

  std::string path_;
  GraphFile<Pose> file_;
  std::unordered_map<std::int64_t, Vertex> vertices_;
  std::unordered_map<std::int64_t, Pose> sensors_;
  std::vector<EdgeEnds> constraints_;  // of graph.constraints, and so on
  std::vector<EdgeEnds> observations_;
};

extern template class GraphBuilder<SE2>;
extern template class GraphBuilder<SE3>;

}  // namespace loopgrid
