#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "backend/geometry/se2.h"
#include "backend/geometry/se3.h"

namespace loopgrid {

/// A measured relative pose between two nodes with its information matrix. Pose is SE2 or SE3.
template <typename Pose>
struct Constraint {
  using Information = Eigen::Matrix<double, Pose::kDof, Pose::kDof>;

  int from = 0;
  int to = 0;
  Pose T_from_to;  ///< measured pose of `to` in `from`
  /// Symmetric and positive semi-definite; order of Pose::Tangent, in `to`'s measured frame.
  Information information = Information::Identity();
  bool robust = false;  ///< may be wrong: the optimiser's robust loss applies to it

  bool operator==(const Constraint&) const = default;
};

/// A landmark as a node has seen it: its measured position with the information matrix.
template <typename Pose>
struct LandmarkObservation {
  using Point = typename Pose::Point;
  using Information = Eigen::Matrix<double, Point::RowsAtCompileTime, Point::RowsAtCompileTime>;

  int node = 0;
  int landmark = 0;
  Point p_node = Point::Zero();  ///< measured position of the landmark in the node's frame
  Information information = Information::Identity();
  bool robust = false;  ///< see Constraint

  bool operator==(const LandmarkObservation&) const = default;
};

/// The graph of the tutorial: poses and point landmarks are nodes, constraints and observations are
/// edges. Plain data.
template <typename Pose>
struct PoseGraph {
  std::vector<Pose> poses;  ///< T_map_node
  std::vector<Constraint<Pose>> constraints;
  std::vector<int> fixed;  ///< nodes that an optimiser must not move

  std::vector<typename Pose::Point> landmarks;  ///< p_map
  std::vector<LandmarkObservation<Pose>> observations;

  bool operator==(const PoseGraph&) const = default;
};

/// Throws Error (kInput) naming the first pose, landmark, constraint or observation that is not
/// finite, the first that refers to a node or landmark that the graph does not have, the first
/// constraint that joins a node to itself, and the first information matrix that is not symmetric
/// or not positive semi-definite (up to kInformationRounding).
template <typename Pose>
void Validate(const PoseGraph<Pose>& graph);

/// The parts of a graph that are not joined to each other: for each node, and for each landmark,
/// the first node (lowest index) of its part. A landmark that no node has seen has -1.
struct Components {
  std::vector<int> of_node;
  std::vector<int> of_landmark;
};

template <typename Pose>
Components ConnectedComponents(const PoseGraph<Pose>& graph);

/// The nodes that make the optimum unique, ascending: `graph.fixed`, and the first node of each
/// component without a fixed node. Which node of a component is held makes no difference to
/// relative poses.
template <typename Pose>
std::vector<int> HeldNodes(const PoseGraph<Pose>& graph, const Components& components);

/// Equations minus unknowns, which is what F is on average at the optimum if the information
/// matrices are true.
template <typename Pose>
std::int64_t DegreesOfFreedom(const PoseGraph<Pose>& graph, const Components& components);

}  // namespace loopgrid
