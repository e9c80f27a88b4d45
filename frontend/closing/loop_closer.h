#pragma once

#include <Eigen/Core>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "frontend/closing/closure_matcher.h"
#include "frontend/closing/closure_record.h"
#include "frontend/closing/nodes.h"
#include "frontend/closing/place_finder.h"

namespace loopgrid {

struct LoopCloserOptions {
  ClosureMatcherOptions matcher;
  double gate_sigmas = 3.0;     ///< old nodes this close to the current pose are candidates
  double view_distance = 4.0;   ///< nodes that see the same place may be this far apart, metres
  int recent_nodes = 20;        ///< the newest nodes are not "old": tracking matches with them
  double recent_path = 10.0;    ///< ... nor are those less than this much travel ago, metres
  int same_pass = 5;            ///< candidates this close along the path are one pass
  double window_margin = 0.15;  ///< searched beyond the gate, metres ...
  double window_angle_margin = 0.05;  ///< ... and radians
  int max_candidates = 3;             ///< passes matched for each node
  double map_path = 10.0;          ///< nodes this much travel before and after make the map, metres
  double map_radius = 25.0;        ///< surfaces farther from the old node are left out, metres
  double surroundings_path = 4.0;  ///< of travel, searched with in large windows, metres
  double surroundings_from = 1.0;  ///< windows from this half width on are large, metres
  double max_second_share = 0.92;  ///< a second peak this close to the best makes it ambiguous
  double max_denied_share = 0.3;   ///< of the walls in view that may have vanished, 0..1
  double max_sigma = 0.5;  ///< a match less sure than this in some direction proves nothing, metres
  int min_agreeing = 3;    ///< hypotheses that must agree before one is believed
  double min_agreeing_path = 1.0;  ///< ... and must have been made over this much travel, metres
  double min_separation = 2.0;     ///< of the consistent set, see ConsistentSet
  int horizon_nodes = 20;          ///< hypotheses this many nodes old no longer count
  PlaceFinderOptions place_finder;
  int min_agreeing_anywhere = 4;  ///< as min_agreeing, for a robot that may be anywhere
  int places_a_node = 40;  ///< a search of so many places pays off at every node of a session, one
                           ///< of twice as many at every second one, ...
  int max_node_steps = 4;  ///< ... but at least at every so many
  int eager_nodes = 40;    ///< nodes after which a session that is still lost looks as seldom
};

/// Where an old place may be seen again.
struct ClosureCandidate {
  int node = 0;                  ///< best node of the pass
  double distance = 0.0;         ///< of the current pose from it, metres
  double distance_sigmas = 0.0;  ///< ... beyond the view distance, in sigmas
  SearchWindow window;           ///< in the frame of `node`
};

/// Proposes closures for the newest node and believes those that agree with each other.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopCloserOptions& options = {}) : options_(options) {}

  /// Matches the newest node, whose scan was taken at `timestamp`, against the old places inside
  /// the gate. `covariances[j]`: of node j relative to the newest, in j's own frame. Returns the
  /// indices of records to be believed now; tell Decide() what came of them.
  std::vector<int> Close(const Nodes& nodes, double timestamp,
                         const std::vector<Eigen::Matrix3d>& covariances);

  /// What became of the records that Close() returned: they stay in the graph, or not.
  void Decide(const std::vector<int>& believed, bool kept);

  /// The closure between two nodes was taken out again, or its error is now known.
  void Reject(int from, int to);
  void SetChi2(int from, int to, double chi2);

  /// The nodes from `first_node` on may be anywhere in the map of those before: they are looked for
  /// in all of it until SetLocalized().
  void StartSession(int first_node);
  void SetLocalized();
  bool localized() const { return localized_; }
  int session() const { return session_; }  ///< first node of the latest session

  /// Ends the run: what is still pending found no company.
  void Finish();

  /// Indices of the records that are new or have changed since the last call, in order.
  std::set<int> TakeChanged() { return std::exchange(changed_, {}); }

  const std::vector<ClosureRecord>& records() const { return records_; }

 private:
  const ClosureRecord& record(int index) const { return records_[static_cast<std::size_t>(index)]; }
  ClosureRecord& Change(int index);
  std::optional<int> FindAccepted(int from, int to) const;
  std::optional<ClosureCandidate> Gate(const SE2& T_old_newest,
                                       const Eigen::Matrix3d& covariance) const;
  std::vector<ClosureCandidate> FindCandidates(
      const Nodes& nodes, const std::vector<Eigen::Matrix3d>& covariances) const;
  ClosureOutcome Judge(const ClosureMatch& match) const;
  void Try(const Nodes& nodes, double timestamp, const ClosureCandidate& candidate);
  void TryEverywhere(const Nodes& nodes, double timestamp);
  void Record(const ClosureMatch& match, ClosureRecord record);
  void ExpirePending();
  std::vector<Eigen::Vector2f> Surroundings(const Nodes& nodes, double path) const;
  double Agreement(const Nodes& nodes, const ClosureRecord& a, const ClosureRecord& b) const;
  std::vector<int> Verify(const Nodes& nodes);

  LoopCloserOptions options_;
  std::vector<ClosureRecord> records_;
  std::vector<int> pool_;  // indices of recent records that are pending or accepted
  std::set<int> changed_;
  int session_ = 0;
  bool localized_ = true;
  std::optional<PlaceFinder> finder_;  // while the session is not localized
};

}  // namespace loopgrid
