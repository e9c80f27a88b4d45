#include "apps/view/view_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "apps/output/closure_fields.h"
#include "apps/output/json_writer.h"

namespace loopgrid {
namespace {

constexpr std::size_t kMaxPoses = 64;     // in one batch
constexpr std::size_t kMaxRefused = 200;  // remembered
constexpr double kMaxStep = 5.0;          // metres; longer steps are not motions of the robot

std::string ServerSentEvent(std::string_view name, std::string_view json) {
  return fmt::format("event: {}\ndata: {}\n\n", name, json);
}

/// Text of a JSON object; `add_members` adds what is in it.
std::string ObjectText(const auto& add_members) {
  JsonWriter json(JsonWriter::Layout::kOneLine);
  json.BeginObject();
  add_members(&json);
  json.EndObject();
  return json.Take();
}

/// Text of a JSON object with one member: an array of elements that are already JSON text.
std::string ObjectWithArray(const char* name, const auto& elements) {
  return ObjectText([&](JsonWriter* json) {
    json->Key(name).BeginArray();
    for (const std::string& element : elements) json->Raw(element);
    json->EndArray();
  });
}

/// Adds the four numbers that the page draws of a covariance (x, y, theta) in the frame of `pose`:
/// xx, xy and yy in the map frame, and the angle's.
void AddCovarianceInMap(const SE2& pose, const Eigen::Matrix3d& covariance, JsonWriter* json) {
  constexpr int kDigits = 3;
  const Eigen::Matrix2d rotation = pose.rotation();
  const Eigen::Matrix2d xy = rotation * covariance.topLeftCorner<2, 2>() * rotation.transpose();
  for (const double entry : {xy(0, 0), xy(0, 1), xy(1, 1), covariance(2, 2)}) {
    json->Value(RoundedNumber{entry, kDigits});
  }
}

bool IsRefused(ClosureOutcome outcome) {
  return outcome != ClosureOutcome::kPending && outcome != ClosureOutcome::kAccepted;
}

std::string ClosureJson(const Closure& closure) {
  return ObjectText([&](JsonWriter* json) {
    json->Field("id", closure.id);
    AddClosurePageFields(closure, json);
  });
}

std::string TilesJson(const std::vector<TileVersion>& tiles) {
  JsonWriter json(JsonWriter::Layout::kOneLine);
  json.BeginArray();
  for (const TileVersion& tile : tiles) {
    json.BeginArray().Value(tile.id.level).Value(tile.id.x).Value(tile.id.y);
    json.Value(tile.version).EndArray();
  }
  json.EndArray();
  return json.Take();
}

}  // namespace

ViewState::ViewState(std::string run, double resolution)
    : run_(std::move(run)), resolution_(resolution) {}

void ViewState::Apply(const OnlineUpdate& update) {
  if (update.tracked.scan >= 0) TakeScan(update);
  if (update.nodes != nullptr) TakeNodes(*update.nodes);
  for (const Closure& record : update.closures) TakeClosure(record);
}

void ViewState::TakeScan(const OnlineUpdate& update) {
  const TrackedScan& tracked = update.tracked;
  scans_ = std::max(scans_, std::int64_t{tracked.scan} + 1);
  if (!tracked.matched) ++unmatched_;
  travelled_ += StepTo(update);
  last_place_ = update.place;
  if (tracked.node >= static_cast<int>(nodes_.size())) AddNode(tracked.T_map_robot);
  last_pose_ = PoseJson(update);
  poses_.push_back(last_pose_);
  if (poses_.size() > kMaxPoses) poses_.pop_front();
}

/// The distance between the robot's poses at the last scan and at this one, metres. Both poses are
/// relative to the graph as it is now, so corrections of the graph do not count as motion.
double ViewState::StepTo(const OnlineUpdate& update) const {
  if (!last_place_ || last_place_->node < 0) return 0.0;
  const auto node = static_cast<std::size_t>(last_place_->node);
  SE2 T_map_node;
  if (update.nodes != nullptr && node < update.nodes->poses.size()) {
    T_map_node = update.nodes->poses[node];
  } else if (node < nodes_.size()) {
    T_map_node = nodes_[node].pose;
  } else {
    return 0.0;
  }
  const SE2 T_map_last = T_map_node * last_place_->T_node_robot;
  const double step = (update.tracked.T_map_robot.translation() - T_map_last.translation()).norm();
  return step < kMaxStep ? step : 0.0;
}

std::string ViewState::PoseJson(const OnlineUpdate& update) {
  const TrackedScan& tracked = update.tracked;
  const SE2& pose = tracked.T_map_robot;
  return ObjectText([&](JsonWriter* json) {
    json->Field("scan", tracked.scan)
        .Field("time", FixedNumber{update.timestamp, 3})
        .Field("x", FixedNumber{pose.x(), 3})
        .Field("y", FixedNumber{pose.y(), 3})
        .Field("theta", FixedNumber{pose.theta(), 4});
    json->Key("covariance").BeginArray();
    AddCovarianceInMap(pose, tracked.covariance, json);
    json->EndArray().Key("node");
    if (tracked.node < 0) {
      json->Null();
    } else {
      json->Value(tracked.node);
    }
    json->Field("matched", tracked.matched)
        .Field("localized", tracked.localized)
        .Field("latency_ms", FixedNumber{1e3 * update.latency_seconds, 2});
  });
}

void ViewState::AddNode(const SE2& pose) {
  const bool linked =
      !nodes_.empty() && (nodes_.back().pose.translation() - pose.translation()).norm() < kMaxStep;
  nodes_.push_back({.pose = pose, .linked = linked});
}

void ViewState::TakeNodes(const NodeStates& states) {
  for (std::size_t i = nodes_.size(); i < states.poses.size(); ++i) AddNode(states.poses[i]);
  for (std::size_t i = 0; i < states.poses.size(); ++i) nodes_[i].pose = states.poses[i];
  const std::size_t known = std::min(states.covariances.size(), nodes_.size());
  for (std::size_t i = 0; i < known; ++i) nodes_[i].covariance = states.covariances[i];
  nodes_moved_ = true;
}

void ViewState::TakeClosure(const Closure& record) {
  const auto [place, is_new] = closures_.try_emplace(record.id);
  Closure& closure = place->second;
  const bool was_refused = !is_new && IsRefused(closure.outcome);
  if (!is_new) --outcomes_[closure.outcome];
  closure = record;
  ++outcomes_[record.outcome];
  changed_closures_.insert(record.id);
  if (!IsRefused(record.outcome) || was_refused) return;
  refused_.push_back(record.id);
  if (refused_.size() <= kMaxRefused) return;
  const auto oldest = closures_.find(refused_.front());
  refused_.pop_front();
  if (oldest != closures_.end() && IsRefused(oldest->second.outcome)) {
    changed_closures_.erase(oldest->first);
    closures_.erase(oldest);
  }
}

void ViewState::AddNodes(std::size_t first, JsonWriter* json) const {
  json->Field("first", first).Key("nodes").BeginArray();
  for (std::size_t i = first; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    json->BeginArray();
    json->Value(FixedNumber{node.pose.x(), 3})
        .Value(FixedNumber{node.pose.y(), 3})
        .Value(FixedNumber{node.pose.theta(), 4});
    AddCovarianceInMap(node.pose, node.covariance, json);
    json->Value(node.linked ? 1 : 0).EndArray();
  }
  json->EndArray();
}

std::string ViewState::CountersJson() const {
  const auto count = [this](ClosureOutcome outcome) {
    const auto found = outcomes_.find(outcome);
    return found == outcomes_.end() ? 0 : found->second;
  };
  std::int64_t tried = 0;
  for (const auto& [outcome, number] : outcomes_) tried += number;
  const std::int64_t accepted = count(ClosureOutcome::kAccepted);
  const std::int64_t pending = count(ClosureOutcome::kPending);
  return ObjectText([&](JsonWriter* json) {
    json->Field("scans", scans_)
        .Field("unmatched", unmatched_)
        .Field("nodes", nodes_.size())
        .Field("accepted", accepted)
        .Field("pending", pending)
        .Field("refused", tried - accepted - pending)
        .Field("travelled", FixedNumber{travelled_, 2});
  });
}

std::string ViewState::TakeChanges(const std::vector<TileVersion>& tiles, bool with_moved_nodes) {
  std::string text;
  if (nodes_moved_ && with_moved_nodes) {
    nodes_told_ = 0;
    nodes_moved_ = false;
  }
  if (nodes_told_ < nodes_.size()) {
    text += ServerSentEvent("nodes",
                            ObjectText([this](JsonWriter* json) { AddNodes(nodes_told_, json); }));
    nodes_told_ = nodes_.size();
  }
  if (!poses_.empty()) {
    text += ServerSentEvent("poses", ObjectWithArray("poses", poses_));
  }
  if (!changed_closures_.empty()) {
    std::vector<std::string> changed;
    for (const ClosureId id : changed_closures_) changed.push_back(ClosureJson(closures_.at(id)));
    text += ServerSentEvent("closures", ObjectWithArray("closures", changed));
  }
  if (!poses_.empty() || !changed_closures_.empty())
    text += ServerSentEvent("counters", CountersJson());
  poses_.clear();
  changed_closures_.clear();
  if (!tiles.empty())
    text += ServerSentEvent("tiles", ObjectText([&tiles](JsonWriter* json) {
                              json->Key("tiles").Raw(TilesJson(tiles));
                            }));
  if (ended_ && !end_told_) text += ServerSentEvent("end", "{}");
  end_told_ = ended_;
  return text;
}

std::string ViewState::Snapshot(const std::vector<TileVersion>& tiles) const {
  const std::string text = ObjectText([&](JsonWriter* json) {
    json->Field("run", run_)
        .Field("resolution", resolution_)
        .Field("tile_side", kTileSide)
        .Field("tile_levels", kTileLevels)
        .Field("ended", ended_);
    json->Key("pose").Raw(last_pose_.empty() ? "null" : last_pose_);
    AddNodes(0, json);
    json->Key("closures").BeginArray();
    for (const auto& [id, closure] : closures_) json->Raw(ClosureJson(closure));
    json->EndArray();
    json->Key("counters").Raw(CountersJson()).Key("tiles").Raw(TilesJson(tiles));
  });
  return ServerSentEvent("state", text);
}

}  // namespace loopgrid
