#include "backend/files/graph_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>

#include "backend/guess/initial_guess.h"

namespace loopgrid {

template <typename Pose>
Error GraphBuilder<Pose>::ErrorAt(std::int64_t line, const std::string& problem) const {
  return Error(ErrorCode::kInput, fmt::format("{}:{}: {}", path_, line, problem));
}

template <typename Pose>
void GraphBuilder<Pose>::AddVertex(const VertexMention& name, const Vertex& vertex) {
  if (vertices_.emplace(name.id, vertex).second) return;
  throw ErrorAt(name.line, fmt::format("vertex {} for the second time", name.id));
}

template <typename Pose>
void GraphBuilder<Pose>::AddNode(const VertexMention& name, const Pose& pose) {
  AddVertex(name, {Kind::kNode, static_cast<int>(file_.graph.poses.size())});
  file_.ids.nodes.push_back(name.id);
  file_.graph.poses.push_back(pose);
}

template <typename Pose>
void GraphBuilder<Pose>::AddLandmark(const VertexMention& name, const Point& p_map) {
  AddVertex(name, {Kind::kLandmark, static_cast<int>(file_.graph.landmarks.size())});
  file_.ids.landmarks.push_back(name.id);
  file_.graph.landmarks.push_back(p_map);
}

template <typename Pose>
void GraphBuilder<Pose>::AddConstraint(const EdgeEnds& ends, const Constraint<Pose>& constraint) {
  if (ends.from == ends.to) {
    throw ErrorAt(ends.line, fmt::format("the edge joins vertex {} to itself", ends.from));
  }
  file_.graph.constraints.push_back(constraint);
  constraints_.push_back(ends);
}

template <typename Pose>
void GraphBuilder<Pose>::AddObservation(const EdgeEnds& ends,
                                        const LandmarkObservation<Pose>& observation) {
  file_.graph.observations.push_back(observation);
  observations_.push_back(ends);
}

template <typename Pose>
void GraphBuilder<Pose>::AddSensor(const VertexMention& name, const Pose& T_node_sensor) {
  if (sensors_.emplace(name.id, T_node_sensor).second) return;
  throw ErrorAt(name.line, fmt::format("parameter {} for the second time", name.id));
}

template <typename Pose>
const Pose& GraphBuilder<Pose>::Sensor(const VertexMention& name) const {
  const auto found = sensors_.find(name.id);
  if (found != sensors_.end()) return found->second;
  throw ErrorAt(name.line, fmt::format("parameter {} is not in the lines before", name.id));
}

template <typename Pose>
GraphFile<Pose> GraphBuilder<Pose>::Finish(const std::vector<VertexMention>& fixed,
                                           GraphNotes* notes) {
  PoseGraph<Pose>& graph = file_.graph;
  const bool has_edges_only = vertices_.empty();
  if (has_edges_only) AddMentionedVertices();
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    const EdgeEnds& ends = constraints_[k];
    graph.constraints[k].from = Find({ends.from, ends.line}, Kind::kNode);
    graph.constraints[k].to = Find({ends.to, ends.line}, Kind::kNode);
  }
  for (std::size_t k = 0; k < observations_.size(); ++k) {
    const EdgeEnds& ends = observations_[k];
    graph.observations[k].node = Find({ends.from, ends.line}, Kind::kNode);
    graph.observations[k].landmark = Find({ends.to, ends.line}, Kind::kLandmark);
  }
  for (const VertexMention& name : fixed) graph.fixed.push_back(Find(name, Kind::kNode));
  std::sort(graph.fixed.begin(), graph.fixed.end());
  graph.fixed.erase(std::unique(graph.fixed.begin(), graph.fixed.end()), graph.fixed.end());
  if (has_edges_only) {
    GuessVertices();
    notes->guessed_nodes += static_cast<std::int64_t>(graph.poses.size());
  }
  return std::move(file_);
}

template <typename Pose>
void GraphBuilder<Pose>::AddMentionedVertices() {
  std::set<std::int64_t> nodes;
  std::set<std::int64_t> landmarks;
  for (const EdgeEnds& ends : constraints_) nodes.insert({ends.from, ends.to});
  for (const EdgeEnds& ends : observations_) {
    nodes.insert(ends.from);
    landmarks.insert(ends.to);
  }
  for (std::int64_t id : nodes) AddNode({id, 0}, Pose());
  for (std::int64_t id : landmarks) {
    if (!nodes.contains(id)) AddLandmark({id, 0}, Point::Zero());
  }
}

template <typename Pose>
void GraphBuilder<Pose>::GuessVertices() {
  SetSpanningTreeGuess(&file_.graph);
  bool is_finite = true;
  for (const Pose& pose : file_.graph.poses) is_finite &= pose.IsFinite();
  for (const Point& landmark : file_.graph.landmarks) is_finite &= landmark.allFinite();
  if (!is_finite)
    throw Error(ErrorCode::kInput, path_ + ": the edges are too long to be put together");
}

template <typename Pose>
int GraphBuilder<Pose>::Find(const VertexMention& name, Kind kind) const {
  const auto found = vertices_.find(name.id);
  if (found == vertices_.end()) {
    throw ErrorAt(name.line, fmt::format("vertex {} is not in the file", name.id));
  }
  if (found->second.kind == kind) return found->second.index;
  const char* found_and_expected =
      kind == Kind::kLandmark ? "a pose, expected a landmark" : "a landmark, expected a pose";
  throw ErrorAt(name.line, fmt::format("vertex {} is {}", name.id, found_and_expected));
}

template class GraphBuilder<SE2>;
template class GraphBuilder<SE3>;

}  // namespace loopgrid
