#include "frontend/slam/slam.h"

#include <Eigen/Dense>
#include <chrono>
#include <cmath>
#include <utility>

#include "backend/marginals.h"
#include "backend/optimizer.h"
#include "frontend/matching/sensor_model.h"
#include "frontend/slam/loop_closer.h"
#include "frontend/slam/neighbour_linker.h"
#include "frontend/slam/nodes.h"
#include "frontend/slam/tracker.h"

namespace loopgrid {
namespace {

class Stopwatch {
 public:
  explicit Stopwatch(double* total) : total_(total), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    *total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* total_;
  std::chrono::steady_clock::time_point start_;
};

// A scan with its place beside the node it was taken after.
struct ScanEntry {
  double timestamp = 0.0;
  SE2 T_odom_robot;
  int node = 0;  // the last node when it was taken
  SE2 T_node_robot;
  std::unique_ptr<PointScan> points;
};

OptimizerOptions ClosureOptimizerOptions() {
  OptimizerOptions options;
  options.max_iterations = 30;
  options.relative_decrease = 1e-4;
  options.absolute_decrease = 1e-3;
  options.loss.kind = LossKind::kHuber;
  return options;
}

}  // namespace

class Slam::Impl {
 public:
  explicit Impl(const SlamOptions& options)
      : options_(options), tracker_(), closer_(), optimizer_(ClosureOptimizerOptions()) {
    options_.Validate();
    nodes_.graph = &graph_;
  }

  TrackedScan AddScan(const Observation& observation) {
    ScanEntry entry;
    entry.timestamp = observation.timestamp;
    entry.T_odom_robot = observation.T_odom_robot;
    entry.points = std::make_unique<PointScan>(sensor_.Interpret(observation.scan));
    const bool first = scans_.empty();
    const SE2 motion =
        first ? SE2() : scans_.back().T_odom_robot.Inverse() * observation.T_odom_robot;
    scans_.push_back(std::move(entry));
    ++statistics_.scans;
    return first ? AddFirstNode() : Track(motion);
  }

  void Finish() {
    const Stopwatch stopwatch(&statistics_.times.finishing);
    closer_.Finish();
    const std::size_t before = graph_.constraints.size();
    int rounds = getenv("ROUNDS") ? atoi(getenv("ROUNDS")) : 2;
    for (int round = 0; round < rounds; ++round) {
      graph_.constraints.resize(before);
      NeighbourLinkerOptions op;
      if (getenv("ND")) op.distance = atof(getenv("ND"));
      if (getenv("NP")) op.map_path = atof(getenv("NP"));
      if (getenv("NI")) op.min_inlier_share = atof(getenv("NI"));
      for (const Constraint& link : LinkNeighbours(nodes_, op)) {
        graph_.constraints.push_back(link);
      }
      Optimizer optimizer(ClosureOptimizerOptions());
      optimizer.Optimize(&graph_);
    }
  }

  PoseGraph graph_;
  Nodes nodes_;
  std::vector<int> node_scans_;
  std::vector<ScanEntry> scans_;
  SlamStatistics statistics_;
  SlamOptions options_;

  const LoopCloser& closer() const { return closer_; }

 private:
  TrackedScan AddFirstNode() {
    AppendNode(SE2());
    tracker_.SetMap(RecentScans(), SE2());
    return {SE2(), Eigen::Matrix3d::Zero(), true, 0, false};
  }

  TrackedScan Track(const SE2& motion) {
    TrackedPose tracked;
    {
      const Stopwatch stopwatch(&statistics_.times.tracking);
      tracked = tracker_.Track(*scans_.back().points, motion);
    }
    if (!tracked.matched) ++statistics_.failed_matches;
    motion_since_node_ = motion_since_node_ * motion;
    const int last = nodes_.size() - 1;
    const SE2 T_node_robot = nodes_.pose(last).Inverse() * tracked.T_map_robot;
    scans_.back().node = last;
    scans_.back().T_node_robot = T_node_robot;

    TrackedScan result;
    result.T_map_robot = tracked.T_map_robot;
    result.matched = tracked.matched;
    result.covariance = SequentialCovariance(tracked);
    if (T_node_robot.translation().norm() >= options_.node_distance ||
        std::abs(T_node_robot.theta()) >= options_.node_angle) {
      graph_.constraints.push_back(
          {last, last + 1, T_node_robot, result.covariance.inverse(), false});
      result.node = AppendNode(tracked.T_map_robot);
      result.optimized = CloseLoops();
      const Stopwatch stopwatch(&statistics_.times.tracking);
      tracker_.SetMap(RecentScans(), nodes_.pose(result.node));
      result.T_map_robot = nodes_.pose(result.node);
    }
    return result;
  }

  int AppendNode(const SE2& pose) {
    const int node = nodes_.size();
    graph_.poses.push_back(pose);
    nodes_.scans.push_back(scans_.back().points.get());
    node_scans_.push_back(static_cast<int>(scans_.size()) - 1);
    scans_.back().node = node;
    scans_.back().T_node_robot = SE2();
    motion_since_node_ = SE2();
    return node;
  }

  std::vector<PlacedScan> RecentScans() const {
    std::vector<PlacedScan> placed;
    for (int k = std::max(nodes_.size() - 20, 0); k < nodes_.size(); ++k) {
      placed.push_back({&nodes_.scan(k), nodes_.pose(k)});
    }
    return placed;
  }

  // Odometry since the last node, fused with the match where there was one.
  Eigen::Matrix3d SequentialCovariance(const TrackedPose& tracked) const {
    const Eigen::Matrix3d odometry = noise_.Covariance(motion_since_node_);
    if (!tracked.matched) return 4.0 * odometry;
    return (odometry.inverse() + tracked.covariance.inverse()).inverse();
  }

  bool CloseLoops() {
    std::vector<int> believed;
    {
      const Stopwatch stopwatch(&statistics_.times.closing);
      const std::vector<Eigen::Matrix3d> covariances =
          RelativeCovariances(graph_, nodes_.size() - 1).value();
      believed = closer_.Close(nodes_, covariances);
    }
    if (believed.empty()) return false;
    const Stopwatch stopwatch(&statistics_.times.optimizing);
    return Believe(believed);
  }

  // Takes closures into the graph; those that stay in contradiction with it go out again.
  bool Believe(const std::vector<int>& believed) {
    const std::vector<SE2> before = graph_.poses;
    const std::size_t first = graph_.constraints.size();
    for (int index : believed) {
      ClosureRecord& record = closer_.record(index);
      graph_.constraints.push_back(
          {record.from, record.to, record.T_from_to, record.covariance.inverse(), true});
      record.outcome = ClosureOutcome::kAccepted;
    }
    optimizer_.Optimize(&graph_);
    double worst = 0.0;
    for (std::size_t k = 0; k < believed.size(); ++k) {
      ClosureRecord& record = closer_.record(believed[k]);
      const Constraint& c = graph_.constraints[first + k];
      const Eigen::Vector3d e =
          (c.T_from_to.Inverse() * nodes_.Between(c.from, c.to)).coordinates();
      record.chi2 = e.dot(c.information * e);
      worst = std::max(worst, record.chi2);
    }
    if (worst < 30.0) return true;
    graph_.constraints.resize(first);
    graph_.poses = before;
    for (int index : believed) closer_.record(index).outcome = ClosureOutcome::kRejected;
    return false;
  }

  SensorModel sensor_;
  Tracker tracker_;
  LoopCloser closer_;
  Optimizer optimizer_;
  OdometryNoise noise_;
  SE2 motion_since_node_;
};

Slam::Slam(const SlamOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

TrackedScan Slam::AddScan(const Observation& observation) { return impl_->AddScan(observation); }
void Slam::Finish() { impl_->Finish(); }
const PoseGraph& Slam::graph() const { return impl_->graph_; }
const std::vector<int>& Slam::node_scans() const { return impl_->node_scans_; }
int Slam::scan_count() const { return static_cast<int>(impl_->scans_.size()); }
double Slam::scan_timestamp(int scan) const {
  return impl_->scans_[static_cast<std::size_t>(scan)].timestamp;
}
SE2 Slam::scan_odometry(int scan) const {
  return impl_->scans_[static_cast<std::size_t>(scan)].T_odom_robot;
}
std::vector<SE2> Slam::ScanPoses() const {
  std::vector<SE2> poses;
  poses.reserve(impl_->scans_.size());
  for (const ScanEntry& scan : impl_->scans_) {
    poses.push_back(impl_->nodes_.pose(scan.node) * scan.T_node_robot);
  }
  return poses;
}
std::span<const Eigen::Vector2f> Slam::scan_hits(int scan) const {
  return impl_->scans_[static_cast<std::size_t>(scan)].points->hits;
}
std::span<const Eigen::Vector2f> Slam::scan_no_returns(int scan) const {
  return impl_->scans_[static_cast<std::size_t>(scan)].points->no_returns;
}
SE2 Slam::scan_laser(int scan) const {
  return impl_->scans_[static_cast<std::size_t>(scan)].points->T_robot_laser;
}
const std::vector<ClosureRecord>& Slam::closures() const { return impl_->closer().records(); }
std::vector<Eigen::Matrix3d> Slam::NodeCovariances() const {
  return RelativeCovariances(impl_->graph_, impl_->nodes_.size() - 1).value();
}
SlamStatistics Slam::statistics() const { return impl_->statistics_; }

}  // namespace loopgrid
