#include "apps/view/view_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

namespace loopgrid {
namespace {

constexpr std::size_t kMaxPoses = 64;     // in one batch
constexpr std::size_t kMaxRefused = 200;  // remembered
constexpr double kMaxStep = 5.0;  // metres; a robot that is this far off begins a new session

// JSON knows no NaN and no infinity.
std::string Number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "null";
}

std::string SmallNumber(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "null";
}

std::string Event(std::string_view name, std::string_view json) {
  return fmt::format("event: {}\ndata: {}\n\n", name, json);
}

// Covariance (x, y, theta) in the frame of `pose` -> the four numbers that viewers draw, in the map
// frame: xx, xy, yy and that of the angle.
std::string CovarianceInMap(const SE2& pose, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d rotation = pose.rotation();
  const Eigen::Matrix2d xy = rotation * covariance.topLeftCorner<2, 2>() * rotation.transpose();
  return fmt::format("{},{},{},{}", SmallNumber(xy(0, 0)), SmallNumber(xy(0, 1)),
                     SmallNumber(xy(1, 1)), SmallNumber(covariance(2, 2)));
}

std::string Coordinates(const SE2& pose) {
  return fmt::format("{},{},{}", Number(pose.x(), 3), Number(pose.y(), 3), Number(pose.theta(), 4));
}

bool IsRefused(ClosureOutcome outcome) {
  return outcome != ClosureOutcome::kPending && outcome != ClosureOutcome::kAccepted;
}

std::string ClosureJson(std::int64_t id, const Closure& record) {
  return fmt::format(
      R"({{"id":{},"from":{},"to":{},"time":{},"outcome":"{}","reason":"{}","score":{},)"
      R"("distance":{},"distance_sigmas":{}}})",
      id, record.from, record.to, Number(record.timestamp, 3), ToString(record.outcome),
      Explain(record.outcome), Number(record.score, 3),
      Number(record.T_from_to.translation().norm(), 2), Number(record.distance_sigmas, 2));
}

std::string TilesJson(const std::vector<TileVersion>& tiles) {
  std::string text;
  for (const TileVersion& tile : tiles) {
    fmt::format_to(std::back_inserter(text), "{}[{},{},{},{}]", text.empty() ? "" : ",",
                   tile.id.level, tile.id.x, tile.id.y, tile.version);
  }
  return '[' + text + ']';
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

/// How far the robot has moved since the last scan, metres. Both ends are taken from the graph as
/// it is now: a correction of the graph moves both, and is no motion of the robot.
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
  return fmt::format(
      R"({{"scan":{},"time":{},"x":{},"y":{},"theta":{},"covariance":[{}],"node":{},)"
      R"("matched":{},"localized":{},"latency_ms":{}}})",
      tracked.scan, Number(update.timestamp, 3), Number(pose.x(), 3), Number(pose.y(), 3),
      Number(pose.theta(), 4), CovarianceInMap(pose, tracked.covariance),
      tracked.node < 0 ? "null" : std::to_string(tracked.node), tracked.matched, tracked.localized,
      Number(1e3 * update.latency_seconds, 2));
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
  const NodePair pair(record.from, record.to);
  const auto [place, is_new] = closures_.try_emplace(pair);
  ShownClosure& closure = place->second;
  if (is_new) {
    closure.id = next_closure_++;
  } else {
    --outcomes_[closure.record.outcome];
  }
  const bool was_refused = !is_new && IsRefused(closure.record.outcome);
  closure.record = record;
  ++outcomes_[record.outcome];
  changed_closures_.insert(pair);
  if (!IsRefused(record.outcome) || was_refused) return;
  refused_.push_back(pair);
  if (refused_.size() <= kMaxRefused) return;
  const auto oldest = closures_.find(refused_.front());
  refused_.pop_front();
  if (oldest != closures_.end() && IsRefused(oldest->second.record.outcome)) {
    changed_closures_.erase(oldest->first);
    closures_.erase(oldest);
  }
}

std::string ViewState::NodesJson(std::size_t first) const {
  std::string text;
  for (std::size_t i = first; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    fmt::format_to(std::back_inserter(text), "{}[{},{},{}]", i == first ? "" : ",",
                   Coordinates(node.pose), CovarianceInMap(node.pose, node.covariance),
                   node.linked ? 1 : 0);
  }
  return fmt::format(R"("first":{},"nodes":[{}])", first, text);
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
  return fmt::format(
      R"({{"scans":{},"unmatched":{},"nodes":{},"accepted":{},"pending":{},"refused":{},)"
      R"("travelled":{}}})",
      scans_, unmatched_, nodes_.size(), accepted, pending, tried - accepted - pending,
      Number(travelled_, 2));
}

std::string ViewState::TakeChanges(const std::vector<TileVersion>& tiles, bool with_moved_nodes) {
  std::string text;
  if (nodes_moved_ && with_moved_nodes) {
    nodes_told_ = 0;
    nodes_moved_ = false;
  }
  if (nodes_told_ < nodes_.size()) {
    text += Event("nodes", '{' + NodesJson(nodes_told_) + '}');
    nodes_told_ = nodes_.size();
  }
  if (!poses_.empty()) {
    text += Event("poses", fmt::format(R"({{"poses":[{}]}})", fmt::join(poses_, ",")));
  }
  if (!changed_closures_.empty()) {
    std::vector<std::string> changed;
    for (const NodePair& pair : changed_closures_) {
      const ShownClosure& closure = closures_.at(pair);
      changed.push_back(ClosureJson(closure.id, closure.record));
    }
    text += Event("closures", fmt::format(R"({{"closures":[{}]}})", fmt::join(changed, ",")));
  }
  if (!poses_.empty() || !changed_closures_.empty()) text += Event("counters", CountersJson());
  poses_.clear();
  changed_closures_.clear();
  if (!tiles.empty()) text += Event("tiles", fmt::format(R"({{"tiles":{}}})", TilesJson(tiles)));
  if (ended_ && !end_told_) text += Event("end", "{}");
  end_told_ = ended_;
  return text;
}

std::string ViewState::Snapshot(const std::vector<TileVersion>& tiles) const {
  std::vector<std::string> closures;
  for (const auto& [pair, closure] : closures_) {
    closures.push_back(ClosureJson(closure.id, closure.record));
  }
  return Event("state",
               fmt::format(R"({{"run":"{}","resolution":{},"tile_side":{},"tile_levels":{},)"
                           R"("ended":{},"pose":{},{},"closures":[{}],"counters":{},"tiles":{}}})",
                           run_, resolution_, kTileSide, kTileLevels, ended_,
                           last_pose_.empty() ? "null" : last_pose_, NodesJson(0),
                           fmt::join(closures, ","), CountersJson(), TilesJson(tiles)));
}

}  // namespace loopgrid
