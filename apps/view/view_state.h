#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/live/map_tiles.h"
#include "apps/live/online_update.h"
#include "apps/output/json_writer.h"
#include "frontend/closing/closure.h"

namespace loopgrid {

/// The state that viewers have: pose, graph, closures, counters. Makes server-sent events, as text,
/// from updates. Covariances are in the map frame. That of the pose is relative to the first node;
/// those of nodes are relative to the last node, see Slam::NodeCovariances(). One thread may use an
/// object at a time.
class ViewState {
 public:
  /// `run` identifies this run of the program; `resolution` is that of the map, metres.
  ViewState(std::string run, double resolution);

  /// Takes a scan and what it has changed; if its index is negative, only nodes and closures.
  void Apply(const OnlineUpdate& update);

  /// Call after the last update.
  void End() { ended_ = true; }

  /// Events with all changes since the last call, and with `tiles`; empty if nothing has changed.
  /// Nodes that have moved are included only if `with_moved_nodes`, because they are many. Of the
  /// poses only the newest 64 are included.
  std::string TakeChanges(const std::vector<TileVersion>& tiles, bool with_moved_nodes);

  /// One event with the whole state, for a new viewer.
  std::string Snapshot(const std::vector<TileVersion>& tiles) const;

  const std::string& run() const { return run_; }

 private:
  struct Node {
    SE2 pose;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // in the node's own frame
    bool linked = false;                                   // reached from the one before
  };
  static std::string PoseJson(const OnlineUpdate& update);
  void TakeScan(const OnlineUpdate& update);
  double StepTo(const OnlineUpdate& update) const;
  void AddNode(const SE2& pose);
  void TakeNodes(const NodeStates& states);
  void TakeClosure(const Closure& record);
  /// Adds the nodes from `first` on as members "first" and "nodes".
  void AddNodes(std::size_t first, JsonWriter* json) const;
  std::string CountersJson() const;

  std::string run_;
  double resolution_;
  bool ended_ = false;
  bool end_told_ = false;

  std::deque<std::string> poses_;  // JSON, not sent yet
  std::string last_pose_;          // JSON, empty if there was none

  std::vector<Node> nodes_;
  std::size_t nodes_told_ = 0;
  bool nodes_moved_ = false;

  std::map<ClosureId, Closure> closures_;
  std::set<ClosureId> changed_closures_;             // not told yet
  std::deque<ClosureId> refused_;                    // oldest first
  std::map<ClosureOutcome, std::int64_t> outcomes_;  // of all closures ever tried

  std::int64_t scans_ = 0;
  std::int64_t unmatched_ = 0;
  std::optional<ScanPlace> last_place_;  // of the newest scan
  double travelled_ = 0.0;               // metres
};

}  // namespace loopgrid
