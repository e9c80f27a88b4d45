#include "frontend/slam/slam.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "backend/base/error.h"
#include "backend/normal_equations.h"
#include "frontend/matching/sensor_model.h"
#include "frontend/slam/closing_queue.h"
#include "frontend/slam/known_space.h"
#include "frontend/slam/stopwatch.h"
#include "frontend/slam/tracker.h"

namespace loopgrid {
namespace {

constexpr int kTrackedNodes = 20;         // whose scans tracking matches with
constexpr double kUnmatchedFactor = 4.0;  // of the odometry's covariance where a match failed

// Closures take time to be found, and tracking does not wait for them: what became of a node is
// taken so many steps of the robot after it was made, however fast or slow the machine is.
constexpr int kClosingLag = 5;

// Between two scans; no robot drives as far, so it was carried, or its odometry started anew.
constexpr double kCarried = 10.0;            // metres
constexpr double kFarthestCarried = 1000.0;  // metres; beyond, the odometry says nothing at all

// A scan with its place in the graph.
struct ScanEntry {
  double timestamp = 0.0;
  SE2 T_odom_robot;
  SE2 T_robot_laser;
  ScanPlace place;
  std::shared_ptr<const PointScan> points;  // null in known space
};

// How a node came into the graph.
struct NodeOrigin {
  int parent = -1;
  SE2 T_parent_node;   // as tracking saw it
  int first_scan = 0;  // of those between the parent and the node
};

// A node of which closing has not been heard yet.
struct PendingNode {
  int index = 0;
  Eigen::Matrix3d covariance;  // since its parent, frame of the node
  std::int64_t due = 0;        // the step of the robot at which it is heard of
};

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

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
      : options_((options.Validate(), options)), closing_(options.threads > 1) {}

  TrackedScan AddScan(const Observation& observation) {
    if (!observation.T_odom_robot.coordinates().allFinite()) {
      throw Error(ErrorCode::kInput,
                  fmt::format("odometry of scan {} is not finite", scans_.size()));
    }
    const SE2 motion =
        scans_.empty() ? SE2() : scans_.back().T_odom_robot.Inverse() * observation.T_odom_robot;
    const bool carried = observation.new_session || motion.translation().norm() > kCarried;
    ScanEntry entry;
    entry.timestamp = observation.timestamp;
    entry.T_odom_robot = observation.T_odom_robot;
    entry.T_robot_laser = observation.scan.T_robot_laser;
    entry.points = std::make_shared<const PointScan>(sensor_.Interpret(observation.scan));
    scans_.push_back(std::move(entry));
    ++statistics_.scans;

    TrackedScan result;
    result.scan = static_cast<int>(scans_.size()) - 1;
    if (origins_.empty()) {
      AddFirstNode(&result);
    } else if (carried) {
      BeginSession(CarriedMotion(motion), &result);
    } else {
      Track(motion, &result);
      if (HasMoved()) TakeStep(&result);
    }
    result.T_map_robot = Pose(reference_) * T_reference_robot_;
    result.covariance =
        ComposeCovariances(map_covariances_[Index(reference_)], T_reference_robot_, covariance_);
    result.localized = localized_;
    scans_.back().place = {reference_, T_reference_robot_};
    if (is_known_) {
      scans_.back().points.reset();
      ++statistics_.known_scans;
    }
    return result;
  }

  void Finish() {
    TrackedScan ignored;
    while (!pending_.empty()) TakeNews(&ignored);
    const Stopwatch stopwatch(&statistics_.times.finishing);
    Apply(closing_.Finish(), &ignored);
  }

  // The node's pose and the scan's place beside it, shifted in proportion to its share of the way
  // by what the graph has changed between this node and the next.
  SE2 ScanPose(int scan) const {
    const ScanPlace& place = scans_[Index(scan)].place;
    const SE2& node = Pose(place.node);
    const auto after = std::upper_bound(node_scans_.begin(), node_scans_.end(), scan);
    if (after == node_scans_.end()) return node * place.T_node_robot;
    const int next = static_cast<int>(after - node_scans_.begin());
    const NodeOrigin& origin = origins_[Index(next)];
    if (origin.parent != place.node || scan < origin.first_scan) return node * place.T_node_robot;
    const double share =
        static_cast<double>(scan - origin.first_scan) / (*after - origin.first_scan);
    const SE2 change = origin.T_parent_node.Inverse() * (node.Inverse() * Pose(next));
    return node * place.T_node_robot * SE2::Exp(share * change.Log());
  }

  SlamStatistics Statistics() const {
    SlamStatistics statistics = statistics_;
    PoseGraph<SE2> before = graph_;
    statistics.error_after = TotalError(before, {});
    for (std::size_t k = 0; k < node_scans_.size(); ++k) {
      before.poses[k] = scans_[Index(node_scans_[k])].T_odom_robot;
    }
    statistics.error_before = TotalError(before, {});
    return statistics;
  }

  const std::deque<ScanEntry>& scans() const { return scans_; }
  const std::vector<int>& node_scans() const { return node_scans_; }
  const PoseGraph<SE2>& graph() const { return graph_; }
  const std::vector<ClosureRecord>& closures() const { return closures_; }
  const std::vector<Eigen::Matrix3d>& covariances() const { return relative_covariances_; }

 private:
  int NodeCount() const { return static_cast<int>(origins_.size()); }
  const SE2& Pose(int node) const { return graph_.poses[Index(node)]; }

  void AddFirstNode(TrackedScan* result) {
    result->matched = true;
    AddNode(NewNode(), result);
    SetTrackingMap();
  }

  // The robot may be anywhere now: a new chain of nodes, tied to the rest by what little is known.
  void BeginSession(const SE2& motion, TrackedScan* result) {
    result->matched = true;
    NewNode node;
    node.parent = reference_;
    node.T_parent_node = T_reference_robot_ * motion;
    node.covariance = CarriedCovariance(motion);
    node.gap = kFarthestCarried;
    node.new_session = true;
    is_known_ = false;
    tracked_.clear();
    session_ = NodeCount();
    localized_ = false;
    AddNode(std::move(node), result);
    SetTrackingMap();
  }

  void Track(const SE2& motion, TrackedScan* result) {
    const Stopwatch stopwatch(&statistics_.times.tracking);
    const TrackedPose tracked = tracker_.Track(*scans_.back().points, motion);
    motion_since_reference_ = motion_since_reference_ * motion;
    travel_ += motion.translation().norm();
    if (!tracked.matched) {
      ++statistics_.failed_matches;
      if (tracked.unusable) ++statistics_.unusable_scans;
    }
    T_reference_robot_ = Pose(reference_).Inverse() * tracked.T_map_robot;
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
      Refer(known_nodes_.front());
    } else {
      NewNode node;
      node.parent = reference_;
      node.T_parent_node = T_reference_robot_;
      node.covariance = covariance_;
      node.gap = travel_;
      AddNode(std::move(node), result);
    }
    while (!pending_.empty() && pending_.front().due <= steps_) TakeNews(result);
    SetTrackingMap();
  }

  void AddNode(NewNode node, TrackedScan* result) {
    const int index = NodeCount();
    const int parent = node.parent;
    // No scan is on the way to where the robot was carried.
    const int first_scan = node.new_session ? result->scan : reference_scan_;
    origins_.push_back({parent, node.T_parent_node, first_scan});
    pending_.push_back({index, node.covariance, steps_ + kClosingLag});
    Append(pending_.back());
    node_scans_.push_back(result->scan);
    tracked_.push_back(index);
    if (std::ssize(tracked_) > kTrackedNodes) tracked_.pop_front();
    node.timestamp = scans_.back().timestamp;
    node.scan = scans_.back().points;
    closing_.Submit(std::move(node));
    reference_ = index;
    T_reference_robot_ = SE2();
    covariance_ = Eigen::Matrix3d::Zero();
    reference_scan_ = result->scan;
    motion_since_reference_ = SE2();
    travel_ = 0.0;
    result->node = index;
  }

  // Goes on from another node, which is near.
  void Refer(int node) {
    T_reference_robot_ = Pose(node).Inverse() * (Pose(reference_) * T_reference_robot_);
    reference_ = node;
    reference_scan_ = static_cast<int>(scans_.size()) - 1;
    motion_since_reference_ = SE2();
  }

  // Whether the robot is still where old nodes explain what it sees.
  bool StaysKnown() {
    const bool stays = inlier_share_ >= options_.known_space.min_inlier_share &&
                       IsKnown(graph_, NodeCount(), session_, Position(), options_.known_space);
    if (stays) {
      known_nodes_ = NearestNodes(graph_, NodeCount(), Position(), options_.known_space.map_nodes);
    } else {
      tracked_.assign(known_nodes_.rbegin(), known_nodes_.rend());  // the nearest last
    }
    return stays;
  }

  // Whether the robot has come to where old nodes explain what it sees, and the graph says so too.
  bool BecomesKnown() {
    const KnownSpaceOptions& known = options_.known_space;
    if (!localized_ || NodeCount() - newest_closed_ > known.closed_within) return false;
    const int end = OldNodes();
    if (!IsKnown(graph_, end, session_, Position(), known)) return false;
    const std::vector<int> nodes = NearestNodes(graph_, end, Position(), known.map_nodes);
    const SE2 T_map_robot = Pose(reference_) * T_reference_robot_;
    Tracker trial;
    trial.SetMap(Placed(nodes), T_map_robot);
    const TrackedPose tracked = trial.Track(*scans_.back().points, SE2());
    const SE2 shift = T_map_robot.Inverse() * tracked.T_map_robot;
    if (!tracked.matched || tracked.inlier_share < known.min_inlier_share ||
        shift.translation().norm() > known.max_shift || std::abs(shift.theta()) > known.max_turn) {
      return false;
    }
    T_reference_robot_ = Pose(reference_).Inverse() * tracked.T_map_robot;
    covariance_ = tracked.covariance;
    known_nodes_ = nodes;
    return true;
  }

  // How many of the nodes the robot has left behind.
  int OldNodes() const {
    int node = NodeCount() - 1;
    double path = 0.0;
    for (; node > 0 && path <= options_.known_space.recent_path; --node) {
      path += (Pose(node).translation() - Pose(node - 1).translation()).norm();
    }
    return std::max(std::min(node, NodeCount() - options_.known_space.recent_nodes), session_);
  }

  Eigen::Vector2d Position() const { return (Pose(reference_) * T_reference_robot_).translation(); }

  template <typename Range>
  std::vector<PlacedScan> Placed(const Range& nodes) const {
    std::vector<PlacedScan> placed;
    for (int node : nodes) {
      placed.push_back({scans_[Index(node_scans_[Index(node)])].points.get(), Pose(node)});
    }
    return placed;
  }

  void SetTrackingMap() {
    const Stopwatch stopwatch(&statistics_.times.tracking);
    const SE2 T_map_robot = Pose(reference_) * T_reference_robot_;
    tracker_.SetMap(is_known_ ? Placed(known_nodes_) : Placed(tracked_), T_map_robot);
  }

  // Puts a node at the end of the graph as tracking has it.
  void Append(const PendingNode& node) {
    const NodeOrigin& origin = origins_[Index(node.index)];
    if (origin.parent < 0) {
      graph_.poses.push_back(origin.T_parent_node);
      map_covariances_.push_back(Eigen::Matrix3d::Zero());
      return;
    }
    graph_.poses.push_back(Pose(origin.parent) * origin.T_parent_node);
    graph_.constraints.push_back(
        {origin.parent, node.index, origin.T_parent_node, node.covariance.inverse(), false});
    map_covariances_.push_back(ComposeCovariances(map_covariances_[Index(origin.parent)],
                                                  origin.T_parent_node, node.covariance));
  }

  // Takes what became of the oldest pending node.
  void TakeNews(TrackedScan* result) {
    const bool of_this_session = pending_.front().index >= session_;
    pending_.pop_front();
    ClosingNews news = closing_.Take();
    if (of_this_session) localized_ = news.localized;
    Apply(std::move(news), result);
  }

  void Apply(ClosingNews news, TrackedScan* result) {
    statistics_.times.closing += news.closing_seconds;
    statistics_.times.optimizing += news.optimizing_seconds;
    for (const auto& [index, record] : news.records) {
      if (index >= std::ssize(closures_)) closures_.resize(Index(index) + 1);
      closures_[Index(index)] = record;
      if (record.outcome == ClosureOutcome::kAccepted) {
        newest_closed_ = std::max(newest_closed_, record.to);
      }
      result->closures.push_back(index);
    }
    if (!news.optimized) return;
    graph_ = std::move(news.optimized->graph);
    relative_covariances_ = std::move(news.optimized->relative_covariances);
    map_covariances_ = std::move(news.optimized->map_covariances);
    for (const PendingNode& node : pending_) Append(node);
    result->optimized = true;
  }

  SlamOptions options_;
  SensorModel sensor_;
  Tracker tracker_;
  ClosingQueue closing_;
  std::deque<PendingNode> pending_;  // nodes of which closing has not been heard yet

  PoseGraph<SE2> graph_;  // as closing left it, with the pending nodes added
  std::vector<Eigen::Matrix3d> map_covariances_;
  std::vector<Eigen::Matrix3d> relative_covariances_;
  std::vector<ClosureRecord> closures_;
  std::vector<NodeOrigin> origins_;
  std::vector<int> node_scans_;
  std::deque<ScanEntry> scans_;

  int reference_ = 0;  // the node that the robot's pose is relative to
  SE2 T_reference_robot_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  // of that, robot frame
  int reference_scan_ = 0;                                // the first one with this reference
  SE2 motion_since_reference_;                            // odometry
  double travel_ = 0.0;                                   // since the last node, metres
  double inlier_share_ = 0.0;                             // of the latest match
  std::int64_t steps_ = 0;
  std::deque<int> tracked_;  // nodes that make the tracking map
  bool is_known_ = false;
  std::vector<int> known_nodes_;  // ... in known space; the nearest first
  int session_ = 0;               // first node of the latest session
  bool localized_ = true;
  int newest_closed_ = -1;  // newest node with an accepted closure
  SlamStatistics statistics_;
};

Slam::Slam(const SlamOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

TrackedScan Slam::AddScan(const Observation& observation) { return impl_->AddScan(observation); }
void Slam::Finish() { impl_->Finish(); }
const PoseGraph<SE2>& Slam::graph() const { return impl_->graph(); }
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
  const auto& points = impl_->scans()[Index(scan)].points;
  if (points == nullptr) return {};
  return points->hits;
}

std::span<const Eigen::Vector2f> Slam::scan_no_returns(int scan) const {
  const auto& points = impl_->scans()[Index(scan)].points;
  if (points == nullptr) return {};
  return points->no_returns;
}

ScanPlace Slam::scan_place(int scan) const { return impl_->scans()[Index(scan)].place; }

std::shared_ptr<const PointScan> Slam::scan_points(int scan) const {
  return impl_->scans()[Index(scan)].points;
}

SE2 Slam::scan_laser(int scan) const { return impl_->scans()[Index(scan)].T_robot_laser; }

const std::vector<ClosureRecord>& Slam::closures() const { return impl_->closures(); }

std::vector<Eigen::Matrix3d> Slam::NodeCovariances() const { return impl_->covariances(); }

SlamStatistics Slam::statistics() const { return impl_->Statistics(); }

}  // namespace loopgrid
