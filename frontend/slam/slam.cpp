#include "frontend/slam/slam.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "backend/base/error.h"
#include "backend/base/stopwatch.h"
#include "backend/solve/normal_equations.h"
#include "frontend/closing/delayed_graph.h"
#include "frontend/matching/sensor_model.h"
#include "frontend/tracking/known_space.h"
#include "frontend/tracking/scan_trail.h"
#include "frontend/tracking/tracker.h"

namespace loopgrid {
namespace {

constexpr int kTrackedNodes = 20;         // whose scans tracking matches with
constexpr double kUnmatchedFactor = 4.0;  // of the odometry's covariance where a match failed

// Scans nearer to each other than this are taken on one spot ...
constexpr double kSpotDistance = 0.05;  // metres
constexpr double kSpotAngle = 0.05;     // radians
constexpr int kScansOnASpot = 10;       // ... and more of them add nothing to the map

// Between two scans; no robot drives as far, so it was carried, or its odometry started anew.
constexpr double kCarried = 10.0;            // metres
constexpr double kFarthestCarried = 1000.0;  // metres; beyond, the odometry says nothing at all

// Where the robot was carried, for want of anything better.
SE2 CarriedMotion(const SE2& motion) {
  return motion.translation().norm() <= kFarthestCarried ? motion : SE2();
}

Eigen::Matrix3d CarriedCovariance(const SE2& motion) {
  const double sigma = 10.0 + motion.translation().norm();
  return Eigen::Vector3d(sigma * sigma, sigma * sigma, 10.0).asDiagonal();
}

}  // namespace

class Slam::Impl {
 public:
  explicit Impl(const SlamOptions& options)
      : options_((options.Validate(), options)), graph_(options.threads > 1) {}

  TrackedScan AddScan(const Observation& observation) {
    if (!observation.T_odom_robot.coordinates().allFinite()) {
      throw Error(ErrorCode::kInput,
                  fmt::format("odometry of scan {} is not finite", scans_.size()));
    }
    const bool is_first = scans_.size() == 0;
    const SE2 motion =
        is_first ? SE2() : scans_.back().T_odom_robot.Inverse() * observation.T_odom_robot;
    const bool carried = observation.new_session || motion.translation().norm() > kCarried;
    scans_.Add({.timestamp = observation.timestamp,
                .T_odom_robot = observation.T_odom_robot,
                .T_robot_laser = observation.scan.T_robot_laser,
                .place = {},
                .points = std::make_shared<const PointScan>(sensor_.Interpret(observation.scan))});
    ++statistics_.scans;

    TrackedScan result;
    result.scan = scans_.size() - 1;
    if (is_first || carried) {
      BeginSession(CarriedMotion(motion), &result);
    } else {
      Track(motion, &result);
      if (HasMoved()) TakeStep(&result);
    }
    result.T_map_robot = T_map_robot();
    result.covariance =
        ComposeCovariances(graph_.covariance(reference_), T_reference_robot_, covariance_);
    result.localized = graph_.localized();
    scans_.back().place = {reference_, T_reference_robot_};
    if (is_known_) ++statistics_.known_scans;
    if (result.node < 0 && (is_known_ || IsOnTheSpot(result.T_map_robot))) {
      scans_.back().points.reset();
    }
    return result;
  }

  void Finish() {
    const ScopedTimer stopwatch(&statistics_.times.finishing);
    graph_.Finish();
  }

  SlamStatistics Statistics() const {
    SlamStatistics statistics = statistics_;
    statistics.times.closing = graph_.closing_seconds();
    statistics.times.optimizing = graph_.optimizing_seconds();
    PoseGraph<SE2> before = graph_.graph();
    statistics.error_after = TotalError(before, {});
    for (std::size_t k = 0; k < before.poses.size(); ++k) {
      before.poses[k] = scans_[scans_.node_scans()[k]].T_odom_robot;
    }
    statistics.error_before = TotalError(before, {});
    return statistics;
  }

  const ScanTrail& scans() const { return scans_; }
  const DelayedGraph& graph() const { return graph_; }

 private:
  SE2 T_map_robot() const { return graph_.pose(reference_) * T_reference_robot_; }

  // Whether the map has enough scans from here: a robot may be parked for hours.
  bool IsOnTheSpot(const SE2& pose) {
    const SE2 motion = spot_.Inverse() * pose;
    if (motion.translation().norm() > kSpotDistance || std::abs(motion.theta()) > kSpotAngle) {
      spot_ = pose;
      scans_on_spot_ = 0;
    }
    return ++scans_on_spot_ > kScansOnASpot;
  }

  // The first node; or the robot may be anywhere now, and a new chain of nodes begins that is tied
  // to the rest by what little is known.
  void BeginSession(const SE2& motion, TrackedScan* result) {
    result->matched = true;
    NewNode node;
    if (graph_.size() > 0) {
      node.parent = reference_;
      node.T_parent_node = T_reference_robot_ * motion;
      node.covariance = CarriedCovariance(motion);
      node.gap = kFarthestCarried;
      node.new_session = true;
    }
    is_known_ = false;
    tracked_.clear();
    reference_scan_ = result->scan;  // no scan is on the way
    AddNode(std::move(node), result);
    SetTrackingMap();
  }

  void Track(const SE2& motion, TrackedScan* result) {
    const ScopedTimer stopwatch(&statistics_.times.tracking);
    const TrackedPose tracked = tracker_.Track(*scans_.back().points, motion);
    motion_since_reference_ = motion_since_reference_ * motion;
    travel_ += motion.translation().norm();
    if (!tracked.matched) {
      ++statistics_.failed_matches;
      if (tracked.unusable) ++statistics_.unusable_scans;
    }
    T_reference_robot_ = graph_.pose(reference_).Inverse() * tracked.T_map_robot;
    inlier_share_ = tracked.matched ? tracked.inlier_share : 0.0;
    covariance_ = CovarianceSinceReference(tracked);
    result->matched = tracked.matched;
  }

  // Odometry since the reference node, fused with the match where there was one. In known space,
  // where the robot came from elsewhere, the match alone.
  Eigen::Matrix3d CovarianceSinceReference(const TrackedPose& tracked) const {
    if (is_known_ && tracked.matched) return tracked.covariance;
    const Eigen::Matrix3d odometry = OdometryNoise().Covariance(motion_since_reference_);
    if (!tracked.matched) return kUnmatchedFactor * odometry;
    return (odometry.inverse() + tracked.covariance.inverse()).inverse();
  }

  bool HasMoved() const {
    return T_reference_robot_.translation().norm() >= options_.node_distance ||
           std::abs(T_reference_robot_.theta()) >= options_.node_angle;
  }

  // The robot is far enough from its reference: a new node, or in known space an old one.
  void TakeStep(TrackedScan* result) {
    ++steps_;
    is_known_ = is_known_ ? StaysKnown() : BecomesKnown();
    if (is_known_) {
      ReferTo(known_nodes_.front());
    } else {
      NewNode node;
      node.parent = reference_;
      node.T_parent_node = T_reference_robot_;
      node.covariance = covariance_;
      node.gap = travel_;
      AddNode(std::move(node), result);
    }
    result->optimized = graph_.TakeDue(steps_, &result->closures);
    SetTrackingMap();
  }

  void AddNode(NewNode node, TrackedScan* result) {
    scans_.AddNode(node.parent, node.T_parent_node, reference_scan_);
    node.timestamp = scans_.back().timestamp;
    node.scan = scans_.back().points;
    reference_ = graph_.Add(std::move(node), steps_);
    reference_scan_ = result->scan;
    T_reference_robot_ = SE2();
    covariance_ = Eigen::Matrix3d::Zero();
    motion_since_reference_ = SE2();
    travel_ = 0.0;
    tracked_.push_back(reference_);
    while (std::ssize(tracked_) > kTrackedNodes) tracked_.pop_front();
    result->node = reference_;
  }

  // Goes on from another node, which is near.
  void ReferTo(int node) {
    T_reference_robot_ = graph_.pose(node).Inverse() * T_map_robot();
    reference_ = node;
    reference_scan_ = scans_.size() - 1;
    motion_since_reference_ = SE2();
  }

  // Whether the robot is still where old nodes explain what it sees.
  bool StaysKnown() {
    const Eigen::Vector2d position = T_map_robot().translation();
    const bool stays = inlier_share_ >= known_.min_inlier_share &&
                       IsKnown(graph_.graph(), graph_.size(), graph_.session(), position, known_);
    if (stays) {
      known_nodes_ = NearestNodes(graph_.graph(), graph_.size(), position, known_.map_nodes);
    } else {
      tracked_.assign(known_nodes_.rbegin(), known_nodes_.rend());  // the nearest last
    }
    return stays;
  }

  // Whether the robot has come to where old nodes explain what it sees, and the graph says so too.
  bool BecomesKnown() {
    if (!graph_.localized() || graph_.size() - graph_.newest_closed() > known_.closed_within) {
      return false;
    }
    const int end = NodesBehind(graph_.graph(), graph_.session(), known_);
    const SE2 expected = T_map_robot();
    if (!IsKnown(graph_.graph(), end, graph_.session(), expected.translation(), known_)) {
      return false;
    }
    const std::vector<int> nodes =
        NearestNodes(graph_.graph(), end, expected.translation(), known_.map_nodes);
    Tracker trial;
    trial.SetMap(Placed(nodes), expected);
    const TrackedPose tracked = trial.Track(*scans_.back().points, SE2());
    const SE2 shift = expected.Inverse() * tracked.T_map_robot;
    if (!tracked.matched || tracked.inlier_share < known_.min_inlier_share ||
        shift.translation().norm() > known_.max_shift ||
        std::abs(shift.theta()) > known_.max_turn) {
      return false;
    }
    T_reference_robot_ = graph_.pose(reference_).Inverse() * tracked.T_map_robot;
    covariance_ = tracked.covariance;
    known_nodes_ = nodes;
    return true;
  }

  template <typename Range>
  std::vector<PlacedScan> Placed(const Range& nodes) const {
    std::vector<PlacedScan> placed;
    for (int node : nodes) placed.push_back({scans_.NodePoints(node), graph_.pose(node)});
    return placed;
  }

  void SetTrackingMap() {
    const ScopedTimer stopwatch(&statistics_.times.tracking);
    tracker_.SetMap(is_known_ ? Placed(known_nodes_) : Placed(tracked_), T_map_robot());
  }

  SlamOptions options_;
  KnownSpaceOptions known_;
  SensorModel sensor_;
  Tracker tracker_;
  DelayedGraph graph_;
  ScanTrail scans_;
  SlamStatistics statistics_;

  int reference_ = 0;  // the node that the robot's pose is relative to
  SE2 T_reference_robot_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  // of that, robot frame
  int reference_scan_ = 0;                                // the first one with this reference
  SE2 motion_since_reference_;                            // odometry
  double travel_ = 0.0;                                   // since the last node, metres
  SE2 spot_;                                              // where it was when it last moved
  int scans_on_spot_ = 0;
  double inlier_share_ = 0.0;  // of the latest match
  std::int64_t steps_ = 0;

  std::deque<int> tracked_;  // nodes that make the tracking map
  bool is_known_ = false;
  std::vector<int> known_nodes_;  // ... in known space; the nearest first
};

Slam::Slam(const SlamOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

TrackedScan Slam::AddScan(const Observation& observation) { return impl_->AddScan(observation); }
void Slam::Finish() { impl_->Finish(); }
const PoseGraph<SE2>& Slam::graph() const { return impl_->graph().graph(); }
const std::vector<int>& Slam::node_scans() const { return impl_->scans().node_scans(); }
int Slam::scan_count() const { return impl_->scans().size(); }

double Slam::scan_timestamp(int scan) const { return impl_->scans()[scan].timestamp; }

SE2 Slam::scan_odometry(int scan) const { return impl_->scans()[scan].T_odom_robot; }

std::vector<SE2> Slam::ScanPoses() const {
  std::vector<SE2> poses;
  poses.reserve(static_cast<std::size_t>(scan_count()));
  for (int scan = 0; scan < scan_count(); ++scan) {
    poses.push_back(impl_->scans().Pose(scan, graph()));
  }
  return poses;
}

std::span<const Eigen::Vector2f> Slam::scan_hits(int scan) const {
  const auto& points = impl_->scans()[scan].points;
  if (points == nullptr) return {};
  return points->hits;
}

std::span<const Eigen::Vector2f> Slam::scan_no_returns(int scan) const {
  const auto& points = impl_->scans()[scan].points;
  if (points == nullptr) return {};
  return points->no_returns;
}

ScanPlace Slam::scan_place(int scan) const { return impl_->scans()[scan].place; }

std::shared_ptr<const PointScan> Slam::scan_points(int scan) const {
  return impl_->scans()[scan].points;
}

SE2 Slam::scan_laser(int scan) const { return impl_->scans()[scan].T_robot_laser; }

const std::vector<ClosureRecord>& Slam::closures() const { return impl_->graph().closures(); }

std::vector<Eigen::Matrix3d> Slam::NodeCovariances() const {
  return impl_->graph().relative_covariances();
}

SlamStatistics Slam::statistics() const { return impl_->Statistics(); }

}  // namespace loopgrid
