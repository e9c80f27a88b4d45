#include "backend/g2o_format.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "backend/graph_text.h"

namespace loopgrid {
namespace {

/// What six digits explain of a quaternion's distance from length 1.
constexpr double kUnitTolerance = 1e-5;

template <typename Pose>
Pose ReadPose(GraphLine* line);

template <>
SE2 ReadPose<SE2>(GraphLine* line) {
  return SE2(line->Numbers<3>());
}

template <>
SE3 ReadPose<SE3>(GraphLine* line) {
  const Eigen::Vector3d translation = line->Numbers<3>();
  Eigen::Vector4d q = line->Numbers<4>();  // x y z w, as in Eigen::Quaterniond::coeffs
  if (std::abs(q.norm() - 1.0) > kUnitTolerance) {
    const double length = q.stableNorm();
    if (length == 0.0) throw line->ErrorHere("the quaternion is zero");
    line->Note(&line->notes()->normalized_quaternions,
               fmt::format("a quaternion of length {:.6g}, normalised", length));
    q = q.stableNormalized();
  }
  return SE3(translation, Eigen::Quaterniond(q));
}

template <typename Pose>
void ReadNode(GraphLine* line, GraphBuilder<Pose>* builder) {
  const std::int64_t id = line->Id();
  const Pose pose = ReadPose<Pose>(line);
  line->End();
  builder->AddNode({id, line->number()}, pose);
}

template <typename Pose>
void ReadConstraint(GraphLine* line, GraphBuilder<Pose>* builder) {
  const std::int64_t from = line->Id();
  const std::int64_t to = line->Id();
  Constraint<Pose> constraint;
  constraint.T_from_to = ReadPose<Pose>(line);
  constraint.information = line->UpperTriangle<Pose::kDof>();
  line->End();
  line->RequireInformation(constraint.information);
  builder->AddConstraint({from, to, line->number()}, constraint);
}

void ReadLandmark(GraphLine* line, GraphBuilder<SE2>* builder) {
  const std::int64_t id = line->Id();
  const Eigen::Vector2d p_map = line->Numbers<2>();
  line->End();
  builder->AddLandmark({id, line->number()}, p_map);
}

void ReadObservation(GraphLine* line, GraphBuilder<SE2>* builder) {
  const std::int64_t node = line->Id();
  const std::int64_t landmark = line->Id();
  LandmarkObservation<SE2> observation;
  observation.p_node = line->Numbers<2>();
  observation.information = line->UpperTriangle<2>();
  line->End();
  line->RequireInformation(observation.information);
  builder->AddObservation({node, landmark, line->number()}, observation);
}

constexpr std::array<GraphTag<SE2>, 4> kTags2 = {{
    {"EDGE_SE2", "from to x y theta I11 I12 I13 I22 I23 I33", ReadConstraint<SE2>},
    {"EDGE_SE2_XY", "node landmark x y I11 I12 I22", ReadObservation},
    {"VERTEX_SE2", "id x y theta", ReadNode<SE2>},
    {"VERTEX_XY", "id x y", ReadLandmark},
}};

constexpr std::array<GraphTag<SE3>, 2> kTags3 = {{
    {"EDGE_SE3:QUAT", "from to x y z qx qy qz qw I11 I12 ... I66", ReadConstraint<SE3>},
    {"VERTEX_SE3:QUAT", "id x y z qx qy qz qw", ReadNode<SE3>},
}};

void Append(const SE2& pose, std::string* text) { AppendNumbers(pose.coordinates(), text); }

void Append(const SE3& pose, std::string* text) {
  AppendNumbers(pose.translation(), text);
  AppendNumbers(pose.quaternion().coeffs(), text);
}

}  // namespace

template <>
std::span<const GraphTag<SE2>> G2oTags<SE2>() {
  return kTags2;
}

template <>
std::span<const GraphTag<SE3>> G2oTags<SE3>() {
  return kTags3;
}

template <typename Pose>
std::string FormatG2o(const PoseGraph<Pose>& graph, const GraphIds& ids) {
  constexpr bool kPlanar = Pose::kDof == 3;
  const GraphNames names(graph.poses.size(), ids);
  std::string text;
  for (std::size_t node = 0; node < graph.poses.size(); ++node) {
    AppendTag(kPlanar ? "VERTEX_SE2" : "VERTEX_SE3:QUAT", {names.node(node)}, &text);
    Append(graph.poses[node], &text);
    text += '\n';
  }
  for (std::size_t landmark = 0; landmark < graph.landmarks.size(); ++landmark) {
    AppendTag("VERTEX_XY", {names.landmark(landmark)}, &text);
    AppendNumbers(graph.landmarks[landmark], &text);
    text += '\n';
  }
  AppendFixed(graph.fixed, names, &text);
  for (const Constraint<Pose>& constraint : graph.constraints) {
    AppendTag(kPlanar ? "EDGE_SE2" : "EDGE_SE3:QUAT",
              {names.node(constraint.from), names.node(constraint.to)}, &text);
    Append(constraint.T_from_to, &text);
    AppendUpperTriangle(constraint.information, &text);
    text += '\n';
  }
  for (const LandmarkObservation<Pose>& observation : graph.observations) {
    AppendTag("EDGE_SE2_XY", {names.node(observation.node), names.landmark(observation.landmark)},
              &text);
    AppendNumbers(observation.p_node, &text);
    AppendUpperTriangle(observation.information, &text);
    text += '\n';
  }
  return text;
}

template std::string FormatG2o(const PoseGraph<SE2>&, const GraphIds&);
template std::string FormatG2o(const PoseGraph<SE3>&, const GraphIds&);

}  // namespace loopgrid
