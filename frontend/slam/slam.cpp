#include "frontend/slam/slam.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "backend/base/error.h"
#include "backend/normal_equations.h"
#include "frontend/matching/sensor_model.h"
#include "frontend/slam/closure_graph.h"
#include "frontend/slam/loop_closer.h"
#include "frontend/slam/neighbour_linker.h"
#include "frontend/slam/nodes.h"
#include "frontend/slam/stopwatch.h"
#include "frontend/slam/tracker.h"

namespace loopgrid {
namespace {

constexpr int kTrackedNodes = 20;         // the newest nodes whose scans tracking matches with
constexpr double kUnmatchedFactor = 4.0;  // of the odometry's covariance where a match failed

// A scan with its place beside the node it was taken at or after.
struct ScanEntry {
  double timestamp = 0.0;
  SE2 T_odom_robot;
  ScanPlace place;
  std::shared_ptr<const PointScan> points;  // nodes refer to it
};

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

class Slam::Impl {
 public:
  explicit Impl(const SlamOptions& options) : options_(options) {
    options_.Validate();
    nodes_.graph = &graph_.graph();
  }

  TrackedScan AddScan(const Observation& observation) {
    if (!observation.T_odom_robot.coordinates().allFinite()) {
      throw Error(ErrorCode::kInput,
                  fmt::format("odometry of scan {} is not finite", scans_.size()));
    }
    const SE2 motion =
        scans_.empty() ? SE2() : scans_.back().T_odom_robot.Inverse() * observation.T_odom_robot;
    ScanEntry entry;
    entry.timestamp = observation.timestamp;
    entry.T_odom_robot = observation.T_odom_robot;
    entry.points = std::make_shared<const PointScan>(sensor_.Interpret(observation.scan));
    scans_.push_back(std::move(entry));
    ++statistics_.scans;
    if (nodes_.size() == 0) return AddFirstNode();

    TrackedScan result = Track(motion);
    const SE2& step = scans_.back().place.T_node_robot;
    if (step.translation().norm() >= options_.node_distance ||
        std::abs(step.theta()) >= options_.node_angle) {
      result.node = AddNode(result.T_map_robot, step, result.covariance);
      result.optimized = CloseLoops();
      result.T_map_robot = nodes_.pose(result.node);
      SetTrackingMap();
    }
    return result;
  }

  void Finish() {
    const Stopwatch stopwatch(&statistics_.times.finishing);
    closer_.Finish();
    for (const Constraint<SE2>& c : graph_.Settle(LinkNeighbours(nodes_)))
      closer_.Reject(c.from, c.to);
    for (const Constraint<SE2>& c : graph_.graph().constraints) {
      if (c.robust) closer_.SetChi2(c.from, c.to, graph_.Chi2(c));
    }
  }

  // The node's pose and the scan's place beside it, shifted in proportion to its share of the way
  // by what the graph has changed between this node and the next.
  SE2 ScanPose(int scan) const {
    const ScanEntry& entry = scans_[Index(scan)];
    const SE2& node = nodes_.pose(entry.place.node);
    if (entry.place.node + 1 >= nodes_.size()) return node * entry.place.T_node_robot;
    const int first = node_scans_[Index(entry.place.node)];
    const int next = node_scans_[Index(entry.place.node + 1)];
    const double share = static_cast<double>(scan - first) / (next - first);
    const SE2 change = tracked_steps_[Index(entry.place.node)].Inverse() *
                       nodes_.Between(entry.place.node, entry.place.node + 1);
    return node * entry.place.T_node_robot * SE2::Exp(share * change.Log());
  }

  SlamStatistics Statistics() const {
    SlamStatistics statistics = statistics_;
    PoseGraph<SE2> before = graph_.graph();
    statistics.error_after = TotalError(before, {});
    for (int k = 0; k < nodes_.size(); ++k) {
      before.poses[Index(k)] = scans_[Index(node_scans_[Index(k)])].T_odom_robot;
    }
    statistics.error_before = TotalError(before, {});
    return statistics;
  }

  const std::vector<ScanEntry>& scans() const { return scans_; }
  const std::vector<int>& node_scans() const { return node_scans_; }
  const ClosureGraph& graph() const { return graph_; }
  const LoopCloser& closer() const { return closer_; }

 private:
  TrackedScan AddFirstNode() {
    TrackedScan result;
    result.matched = true;
    result.node = AddNode(SE2(), SE2(), Eigen::Matrix3d::Zero());
    SetTrackingMap();
    return result;
  }

  TrackedScan Track(const SE2& motion) {
    const Stopwatch stopwatch(&statistics_.times.tracking);
    ScanEntry& entry = scans_.back();
    const TrackedPose tracked = tracker_.Track(*entry.points, motion);
    motion_since_node_ = motion_since_node_ * motion;
    if (!tracked.matched) {
      ++statistics_.failed_matches;
      if (tracked.unusable) ++statistics_.unusable_scans;
    }
    entry.place.node = nodes_.size() - 1;
    entry.place.T_node_robot = nodes_.pose(entry.place.node).Inverse() * tracked.T_map_robot;
    TrackedScan result;
    result.scan = static_cast<int>(scans_.size()) - 1;
    result.T_map_robot = tracked.T_map_robot;
    result.matched = tracked.matched;
    result.covariance = CovarianceSinceNode(tracked);
    return result;
  }

  // Odometry since the last node, fused with the match where there was one.
  Eigen::Matrix3d CovarianceSinceNode(const TrackedPose& tracked) const {
    const Eigen::Matrix3d odometry = OdometryNoise().Covariance(motion_since_node_);
    if (!tracked.matched) return kUnmatchedFactor * odometry;
    return (odometry.inverse() + tracked.covariance.inverse()).inverse();
  }

  int AddNode(const SE2& T_map_robot, const SE2& T_last_node, const Eigen::Matrix3d& covariance) {
    const int node = nodes_.size();
    graph_.AddNode(T_map_robot, T_last_node, covariance);
    if (node > 0) tracked_steps_.push_back(T_last_node);
    nodes_.scans.push_back(scans_.back().points.get());
    node_scans_.push_back(static_cast<int>(scans_.size()) - 1);
    scans_.back().place.node = node;
    scans_.back().place.T_node_robot = SE2();
    motion_since_node_ = SE2();
    return node;
  }

  void SetTrackingMap() {
    const Stopwatch stopwatch(&statistics_.times.tracking);
    std::vector<PlacedScan> recent;
    for (int k = std::max(nodes_.size() - kTrackedNodes, 0); k < nodes_.size(); ++k) {
      recent.push_back({&nodes_.scan(k), nodes_.pose(k)});
    }
    tracker_.SetMap(recent, nodes_.pose(nodes_.size() - 1));
  }

  // True if the graph was optimised.
  bool CloseLoops() {
    std::vector<int> believed;
    {
      const Stopwatch stopwatch(&statistics_.times.closing);
      believed = closer_.Close(nodes_, scans_.back().timestamp, graph_.relative_covariances());
    }
    if (believed.empty()) return false;
    const Stopwatch stopwatch(&statistics_.times.optimizing);
    std::vector<Constraint<SE2>> closures;
    for (int index : believed) {
      const ClosureRecord& r = closer_.records()[Index(index)];
      closures.push_back({r.from, r.to, r.T_from_to, r.covariance.inverse(), true});
    }
    std::vector<Constraint<SE2>> removed;
    const bool kept = graph_.TryClosures(closures, &removed);
    for (const Constraint<SE2>& c : closures) closer_.SetChi2(c.from, c.to, graph_.Chi2(c));
    closer_.Decide(believed, kept);
    for (const Constraint<SE2>& c : removed) closer_.Reject(c.from, c.to);
    return kept;
  }

  SlamOptions options_;
  SensorModel sensor_;
  Tracker tracker_;
  LoopCloser closer_;
  ClosureGraph graph_;
  Nodes nodes_;
  std::vector<int> node_scans_;
  std::vector<SE2> tracked_steps_;  // from each node to the next, as tracking saw it
  std::vector<ScanEntry> scans_;
  SE2 motion_since_node_;  // odometry
  SlamStatistics statistics_;
};

Slam::Slam(const SlamOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

TrackedScan Slam::AddScan(const Observation& observation) { return impl_->AddScan(observation); }
void Slam::Finish() { impl_->Finish(); }
const PoseGraph<SE2>& Slam::graph() const { return impl_->graph().graph(); }
const std::vector<int>& Slam::node_scans() const { return impl_->node_scans(); }
int Slam::scan_count() const { return static_cast<int>(impl_->scans().size()); }

double Slam::scan_timestamp(int scan) const { return impl_->scans()[Index(scan)].timestamp; }

SE2 Slam::scan_odometry(int scan) const { return impl_->scans()[Index(scan)].T_odom_robot; }

std::vector<SE2> Slam::ScanPoses() const {
  std::vector<SE2> poses;
  poses.reserve(impl_->scans().size());
  for (int scan = 0; scan < scan_count(); ++scan) poses.push_back(impl_->ScanPose(scan));
  return poses;
}

std::span<const Eigen::Vector2f> Slam::scan_hits(int scan) const {
  return impl_->scans()[Index(scan)].points->hits;
}

std::span<const Eigen::Vector2f> Slam::scan_no_returns(int scan) const {
  return impl_->scans()[Index(scan)].points->no_returns;
}

ScanPlace Slam::scan_place(int scan) const { return impl_->scans()[Index(scan)].place; }

std::shared_ptr<const PointScan> Slam::scan_points(int scan) const {
  return impl_->scans()[Index(scan)].points;
}

SE2 Slam::scan_laser(int scan) const { return impl_->scans()[Index(scan)].points->T_robot_laser; }

const std::vector<ClosureRecord>& Slam::closures() const { return impl_->closer().records(); }

std::vector<Eigen::Matrix3d> Slam::NodeCovariances() const {
  return impl_->graph().relative_covariances();
}

SlamStatistics Slam::statistics() const { return impl_->Statistics(); }

}  // namespace loopgrid
