#include "frontend/slam/slam.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "backend/base/error.h"
#include "backend/base/stopwatch.h"
#include "backend/solve/normal_equations.h"
#include "frontend/closing/node_queue.h"
#include "frontend/matching/no_return_rule.h"
#include "frontend/slam/robot_pose.h"
#include "frontend/slam/standstill.h"
#include "frontend/slam/tracking_graph.h"
#include "frontend/tracking/known_space.h"
#include "frontend/tracking/pose_covariance.h"
#include "frontend/tracking/scan_trail.h"
#include "frontend/tracking/tracker.h"

namespace loopgrid {
namespace {

// A large covariance: a robot that was carried may be nearly anywhere.
Eigen::Matrix3d CarriedCovariance(const SE2& motion, const CarriedOptions& options) {
  const double sigma = options.distance + motion.translation().norm();
  return Eigen::Vector3d(sigma * sigma, sigma * sigma, 10.0).asDiagonal();
}

}  // namespace

class Slam::Impl {
 public:
  explicit Impl(const SlamOptions& options)
      : options_((options.Validate(), options)),
        no_return_(options.no_return),
        tracker_(options.tracker),
        queue_(options.threads > 1, options.closing),
        graph_(options.update_lag),
        standstill_(options.standstill),
        robot_(options.tracker.odometry, options.unmatched_factor) {}

  // Section V-A of the tutorial, for one odometry measurement and laser scan.
  TrackedScan AddScan(const Observation& observation) {
    const bool is_first = scans_.size() == 0;
    const SE2 motion = Keep(observation);
    TrackedScan result;
    result.scan = scans_.size() - 1;
    if (is_first || observation.new_session ||
        motion.translation().norm() > options_.carried.distance) {
      // This is the first node, or the robot was carried and a new chain of nodes begins.
      BeginSession(motion, &result);
    } else {
      // The scan is matched with those of the latest nodes, to improve the odometry's estimate.
      Track(motion, &result);
      // Whenever the robot has moved half a metre or turned half a radian ...
      if (HasMoved()) {
        ++steps_;
        is_known_ = is_known_ ? StaysKnown() : BecomesKnown();
        if (is_known_) {
          // ... in a part of the map that is known well enough, its pose refers to an old node;
          ReferTo(known_nodes_.front());
        } else {
          // ... elsewhere the scan becomes a new node, and the match becomes the edge to it. The
          // queue passes the node to the NodePipeline. It searches for closures with the old nodes
          // whose 3 sigma marginal covariance contains the robot, and optimises the graph with
          // each.
          AddNode(EdgeFromReference(), &result);
        }
        // The result for a node is applied a few steps later. It moves the nodes of the map.
        TakeUpdates(&result);
        SetTrackingMap();
      }
    }
    Describe(&result);
    return result;
  }

  void Finish() {
    const ScopedTimer stopwatch(&statistics_.times.finishing);
    std::vector<ClosureId> ignored;
    while (graph_.waiting() > 0) graph_.ApplyOldest(queue_.Take(), &ignored);
    graph_.ApplyLast(queue_.Finish());
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
  const TrackingGraph& graph() const { return graph_; }

 private:
  SE2 T_map_robot() const { return graph_.pose(robot_.reference()) * robot_.T_reference_robot(); }

  SE2 FromReference(const SE2& pose) const {
    return graph_.pose(robot_.reference()).Inverse() * pose;
  }

  // Keeps the scan as points. Returns the motion since the scan before, by odometry.
  SE2 Keep(const Observation& observation) {
    if (!observation.T_odom_robot.coordinates().allFinite()) {
      throw Error(ErrorCode::kInput,
                  fmt::format("odometry of scan {} is not finite", scans_.size()));
    }
    const SE2 motion = scans_.size() == 0
                           ? SE2()
                           : scans_.back().T_odom_robot.Inverse() * observation.T_odom_robot;
    scans_.Add(
        {.timestamp = observation.timestamp,
         .T_odom_robot = observation.T_odom_robot,
         .T_robot_laser = observation.scan.T_robot_laser,
         .place = {},
         .points = std::make_shared<const PointScan>(no_return_.Interpret(observation.scan))});
    ++statistics_.scans;
    return motion;
  }

  // The robot may be anywhere now. Odometry, with a large covariance, joins the new chain of nodes
  // to the rest.
  void BeginSession(SE2 motion, TrackedScan* result) {
    result->matched = true;
    if (motion.translation().norm() > options_.carried.farthest) motion = SE2();
    NewNode node;
    if (graph_.size() > 0) {
      node.parent = robot_.reference();
      node.T_parent_node = robot_.T_reference_robot() * motion;
      node.covariance = CarriedCovariance(motion, options_.carried);
      node.gap = options_.carried.farthest;
      node.new_session = true;
    }
    is_known_ = false;
    tracked_.clear();
    reference_scan_ = result->scan;  // there are no scans between the two nodes
    AddNode(std::move(node), result);
    SetTrackingMap();
  }

  void Track(const SE2& motion, TrackedScan* result) {
    const ScopedTimer stopwatch(&statistics_.times.tracking);
    const TrackedPose tracked = tracker_.Track(*scans_.back().points, motion);
    if (!tracked.matched) {
      ++statistics_.failed_matches;
      if (tracked.unusable) ++statistics_.unusable_scans;
    }
    robot_.Move(motion, FromReference(tracked.T_map_robot),
                tracked.matched ? std::optional(tracked.covariance) : std::nullopt);
    inlier_share_ = tracked.matched ? tracked.inlier_share : 0.0;
    result->matched = tracked.matched;
  }

  bool HasMoved() const {
    const SE2& moved = robot_.T_reference_robot();
    return moved.translation().norm() >= options_.node_distance ||
           std::abs(moved.theta()) >= options_.node_angle;
  }

  NewNode EdgeFromReference() const {
    NewNode node;
    node.parent = robot_.reference();
    node.T_parent_node = robot_.T_reference_robot();
    node.covariance = robot_.edge_covariance();
    node.gap = robot_.travel();
    return node;
  }

  void AddNode(NewNode node, TrackedScan* result) {
    scans_.AddNode(node.parent, node.T_parent_node, reference_scan_);
    node.timestamp = scans_.back().timestamp;
    node.scan = scans_.back().points;
    result->node = graph_.Add(node, steps_);
    queue_.Submit(std::move(node));
    robot_.StartAt(result->node);
    reference_scan_ = result->scan;
    tracked_.push_back(result->node);
    while (std::ssize(tracked_) > options_.tracked_nodes) tracked_.pop_front();
  }

  // From now on the robot's pose refers to another node, which is near.
  void ReferTo(int node) {
    robot_.ReferTo(node, graph_.pose(node).Inverse() * T_map_robot());
    reference_scan_ = scans_.size() - 1;
  }

  void TakeUpdates(TrackedScan* result) {
    while (graph_.IsUpdateDue(steps_)) {
      result->optimized |= graph_.ApplyOldest(queue_.Take(), &result->closures);
    }
  }

  // Whether old nodes still explain the scan.
  bool StaysKnown() {
    const KnownSpaceOptions& known = options_.known_space;
    const Eigen::Vector2d position = T_map_robot().translation();
    const bool stays =
        inlier_share_ >= known.min_inlier_share &&
        IsKnown(graph_.graph(), graph_.size(), graph_.session().first_node, position, known);
    if (stays) {
      known_nodes_ = NearestNodes(graph_.graph(), graph_.size(), position, known.map_nodes);
    } else {
      tracked_.assign(known_nodes_.rbegin(), known_nodes_.rend());  // the nearest last
    }
    return stays;
  }

  // Whether old nodes now explain the scan, and the graph agrees with the pose.
  bool BecomesKnown() {
    const KnownSpaceOptions& known = options_.known_space;
    if (!graph_.session().localized ||
        graph_.size() - graph_.newest_closed() > known.closed_within) {
      return false;
    }
    const int session = graph_.session().first_node;
    const int end = NodesBehind(graph_.graph(), session, known);
    const SE2 expected = T_map_robot();
    if (!IsKnown(graph_.graph(), end, session, expected.translation(), known)) return false;
    const std::vector<int> nodes =
        NearestNodes(graph_.graph(), end, expected.translation(), known.map_nodes);
    Tracker trial(options_.tracker);
    trial.SetMap(Placed(nodes), expected);
    const TrackedPose tracked = trial.Track(*scans_.back().points, SE2());
    const SE2 shift = expected.Inverse() * tracked.T_map_robot;
    if (!tracked.matched || tracked.inlier_share < known.min_inlier_share ||
        shift.translation().norm() > known.max_shift || std::abs(shift.theta()) > known.max_turn) {
      return false;
    }
    robot_.Correct(FromReference(tracked.T_map_robot), tracked.covariance);
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

  // Fills in the pose of the scan. Drops its points if the map does not need them.
  void Describe(TrackedScan* result) {
    result->T_map_robot = T_map_robot();
    result->covariance = ComposeCovariances(graph_.covariance(robot_.reference()),
                                            robot_.T_reference_robot(), robot_.covariance());
    result->localized = graph_.session().localized;
    scans_.back().place = {robot_.reference(), robot_.T_reference_robot()};
    if (is_known_) ++statistics_.known_scans;
    if (result->node < 0 && (is_known_ || standstill_.HasEnough(result->T_map_robot))) {
      scans_.back().points.reset();
    }
  }

  SlamOptions options_;
  NoReturnRule no_return_;
  Tracker tracker_;
  NodeQueue queue_;
  TrackingGraph graph_;
  ScanTrail scans_;
  Standstill standstill_;
  SlamStatistics statistics_;

  RobotPose robot_;
  int reference_scan_ = 0;     // the first scan with this reference
  double inlier_share_ = 0.0;  // of the latest match
  std::int64_t steps_ = 0;     // motions of node_distance or node_angle so far

  std::deque<int> tracked_;  // nodes that make the tracking map
  bool is_known_ = false;
  std::vector<int> known_nodes_;  // those of known space, the nearest first
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

const std::vector<Closure>& Slam::closures() const { return impl_->graph().closures(); }

std::vector<Eigen::Matrix3d> Slam::NodeCovariances() const {
  return impl_->graph().relative_covariances();
}

SlamStatistics Slam::statistics() const { return impl_->Statistics(); }

}  // namespace loopgrid
