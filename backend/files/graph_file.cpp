#include "backend/files/graph_file.h"

#include <fmt/format.h>

#include <array>
#include <span>
#include <string_view>

#include "backend/base/atomic_file.h"
#include "backend/base/gzip.h"
#include "backend/base/line_reader.h"
#include "backend/files/g2o_format.h"
#include "backend/files/toro_format.h"

namespace loopgrid {
namespace {

class GraphReader {
 public:
  GraphReader(const std::string& path, const GraphReadOptions& options, GraphNotes* notes)
      : lines_(path), options_(options), notes_(notes), planar_(path), spatial_(path) {}

  AnyGraphFile Read();

 private:
  template <typename Pose, typename OtherPose>
  bool ReadAs(GraphLine* line, GraphBuilder<Pose>* builder, const GraphBuilder<OtherPose>& other);
  bool ReadFix(GraphLine* line);
  void PassOver(const GraphLine& line);

  LineReader lines_;
  GraphReadOptions options_;
  GraphNotes* notes_;
  GraphBuilder<SE2> planar_;  // one of the two stays empty
  GraphBuilder<SE3> spatial_;
  std::vector<VertexMention> fixed_;
};

AnyGraphFile GraphReader::Read() {
  std::string_view text;
  while (lines_.Next(&text)) {
    if (lines_.too_long()) throw lines_.ErrorHere("the line is too long for a graph file");
    GraphLine line(lines_, text, options_, notes_);
    if (line.tag().empty() || line.tag().front() == '#') continue;
    const bool known =
        ReadAs(&line, &planar_, spatial_) || ReadAs(&line, &spatial_, planar_) || ReadFix(&line);
    if (!known) PassOver(line);
  }
  if (!spatial_.empty()) return spatial_.Finish(fixed_, notes_);
  if (!planar_.empty()) return planar_.Finish(fixed_, notes_);
  throw Error(ErrorCode::kInput,
              lines_.path() + ": no vertex and no edge, expected a g2o or TORO file");
}

template <typename Pose>
const GraphTag<Pose>* FindTag(std::string_view name) {
  for (const auto& tags : {G2oTags<Pose>(), ToroTags<Pose>()}) {
    for (const GraphTag<Pose>& tag : tags) {
      if (tag.name == name) return &tag;
    }
  }
  return nullptr;
}

/// False if the tag is not one of this kind of graphs.
template <typename Pose, typename OtherPose>
bool GraphReader::ReadAs(GraphLine* line, GraphBuilder<Pose>* builder,
                         const GraphBuilder<OtherPose>& other) {
  const GraphTag<Pose>* tag = FindTag<Pose>(line->tag());
  if (tag == nullptr) return false;
  if (!other.empty()) {
    throw line->ErrorHere(
        fmt::format("{} in a {} graph", tag->name, OtherPose::kDof == 3 ? "2D" : "3D"));
  }
  line->Expect(tag->fields);
  tag->read(line, builder);
  return true;
}

bool GraphReader::ReadFix(GraphLine* line) {
  if (line->tag() != "FIX") return false;
  line->Expect("id ...");
  do {
    fixed_.push_back({line->Id(), line->number()});
  } while (!line->AtEnd());
  return true;
}

void GraphReader::PassOver(const GraphLine& line) {
  if (IsG2oData(line.tag())) {
    line.Note(&notes_->data_lines, Quoted(line.tag()) + " is no part of the graph, passed over");
    return;
  }
  const std::string problem = "unknown tag " + Quoted(line.tag());
  if (!options_.lenient) throw line.ErrorHere(problem + ", expected one of g2o or TORO");
  line.Note(&notes_->unknown_tags, problem + ", passed over");
}

bool RemoveSuffix(std::string_view suffix, std::string_view* text) {
  if (!text->ends_with(suffix)) return false;
  text->remove_suffix(suffix.size());
  return true;
}

}  // namespace

AnyGraphFile ReadGraph(const std::string& path, const GraphReadOptions& options,
                       GraphNotes* notes) {
  GraphNotes unread;
  return GraphReader(path, options, notes != nullptr ? notes : &unread).Read();
}

GraphFormat GraphFormatOf(const std::string& path) {
  std::string_view name = path;
  RemoveSuffix(".gz", &name);
  const bool is_toro = name.ends_with(".graph") || name.ends_with(".toro");
  return is_toro ? GraphFormat::kToro : GraphFormat::kG2o;
}

template <typename Pose>
std::string FormatGraph(const PoseGraph<Pose>& graph, const GraphIds& ids, GraphFormat format) {
  if (format == GraphFormat::kG2o) return FormatG2o(graph, ids);
  if (graph.landmarks.empty()) return FormatToro(graph, ids);
  throw Error(ErrorCode::kUsage, "the TORO format has no landmarks");
}

template <typename Pose>
void WriteGraph(const std::string& path, const PoseGraph<Pose>& graph, const GraphIds& ids) {
  const GraphFormat format = GraphFormatOf(path);
  if (format == GraphFormat::kToro && !graph.landmarks.empty()) {
    throw Error(ErrorCode::kOutput, path + ": the TORO format has no landmarks");
  }
  const std::string text = FormatGraph(graph, ids, format);
  WriteFileAtomically(path, path.ends_with(".gz") ? Gzip(text) : text);
}

template std::string FormatGraph(const PoseGraph<SE2>&, const GraphIds&, GraphFormat);
template std::string FormatGraph(const PoseGraph<SE3>&, const GraphIds&, GraphFormat);
template void WriteGraph(const std::string&, const PoseGraph<SE2>&, const GraphIds&);
template void WriteGraph(const std::string&, const PoseGraph<SE3>&, const GraphIds&);

}  // namespace loopgrid
