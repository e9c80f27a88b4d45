#include "backend/files/g2o_format.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "backend/files/graph_text.h"

namespace loopgrid {
namespace {

/// What six digits explain of a quaternion's distance from length 1.
constexpr double kUnitTolerance = 1e-5;

template <typename Pose>
constexpr int kPointSize = Pose::Point::RowsAtCompileTime;

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
  line->RequireInformation(from, to, &constraint.information);
  builder->AddConstraint({from, to, line->number()}, constraint);
}

template <typename Pose>
void ReadLandmark(GraphLine* line, GraphBuilder<Pose>* builder) {
  const std::int64_t id = line->Id();
  const typename Pose::Point p_map = line->Numbers<kPointSize<Pose>>();
  line->End();
  builder->AddLandmark({id, line->number()}, p_map);
}

void ReadSensor(GraphLine* line, GraphBuilder<SE3>* builder) {
  const std::int64_t id = line->Id();
  const SE3 T_node_sensor = ReadPose<SE3>(line);
  line->End();
  builder->AddSensor({id, line->number()}, T_node_sensor);
}

template <typename Pose>
void ReadObservation(GraphLine* line, GraphBuilder<Pose>* builder) {
  constexpr bool kHasSensor = std::is_same_v<Pose, SE3>;
  const std::int64_t node = line->Id();
  const std::int64_t landmark = line->Id();
  Pose T_node_sensor;
  if constexpr (kHasSensor) T_node_sensor = builder->Sensor({line->Id(), line->number()});
  LandmarkObservation<Pose> observation;
  observation.p_node = T_node_sensor * line->Numbers<kPointSize<Pose>>();
  auto information = line->UpperTriangle<kPointSize<Pose>>();
  line->End();
  if (!observation.p_node.allFinite()) throw line->ErrorHere("the landmark is too far away");
  line->RequireInformation(node, landmark, &information);
  if constexpr (kHasSensor) {
    const Eigen::Matrix3d R = T_node_sensor.rotation();
    const Eigen::Matrix3d turned = R * information * R.transpose();
    information = 0.5 * (turned + turned.transpose());
    if (!information.allFinite()) throw line->ErrorHere("the information matrix is too large");
  }
  observation.information = information;
  builder->AddObservation({node, landmark, line->number()}, observation);
}

constexpr std::array<GraphTag<SE2>, 4> kTags2 = {{
    {"EDGE_SE2", "from to x y theta I11 I12 I13 I22 I23 I33", ReadConstraint<SE2>},
    {"EDGE_SE2_XY", "node landmark x y I11 I12 I22", ReadObservation<SE2>},
    {"VERTEX_SE2", "id x y theta", ReadNode<SE2>},
    {"VERTEX_XY", "id x y", ReadLandmark<SE2>},
}};

constexpr std::array<GraphTag<SE3>, 5> kTags3 = {{
    {"EDGE_SE3:QUAT", "from to x y z qx qy qz qw I11 I12 ... I66", ReadConstraint<SE3>},
    {"EDGE_SE3_TRACKXYZ", "node landmark sensor x y z I11 I12 I13 I22 I23 I33",
     ReadObservation<SE3>},
    {"VERTEX_SE3:QUAT", "id x y z qx qy qz qw", ReadNode<SE3>},
    {"VERTEX_TRACKXYZ", "id x y z", ReadLandmark<SE3>},
    {"PARAMS_SE3OFFSET", "sensor x y z qx qy qz qw", ReadSensor},
}};

/// What lines are called when they are written.
struct Tags {
  const char* node;
  const char* constraint;
  const char* landmark;
  const char* observation;
};
template <typename Pose>
constexpr Tags kWritten = {"VERTEX_SE2", "EDGE_SE2", "VERTEX_XY", "EDGE_SE2_XY"};
template <>
constexpr Tags kWritten<SE3> = {"VERTEX_SE3:QUAT", "EDGE_SE3:QUAT", "VERTEX_TRACKXYZ",
                                "EDGE_SE3_TRACKXYZ"};

void Append(const SE2& pose, GraphText* text) { text->Numbers(pose.coordinates()); }

void Append(const SE3& pose, GraphText* text) {
  text->Numbers(pose.translation());
  text->Numbers(pose.quaternion().coeffs());  // x y z w
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

bool IsG2oData(std::string_view tag) {
  constexpr std::array<std::string_view, 4> kData = {"ROBOTLASER1", "RAWLASER1", "VERTEX_TAG",
                                                     "VERTEX_ELLIPSE"};
  return tag.starts_with("PARAMS_") || std::find(kData.begin(), kData.end(), tag) != kData.end();
}

template <typename Pose>
std::string FormatG2o(const PoseGraph<Pose>& graph, const GraphIds& ids) {
  constexpr bool kHasSensor = std::is_same_v<Pose, SE3>;
  constexpr std::int64_t kSensor = 0;
  const GraphNames names(graph.poses.size(), ids);
  const Tags& tags = kWritten<Pose>;
  GraphText text;
  if (kHasSensor && !graph.observations.empty()) {
    text.Begin("PARAMS_SE3OFFSET", {kSensor});
    Append(Pose(), &text);
  }
  for (std::size_t node = 0; node < graph.poses.size(); ++node) {
    text.Begin(tags.node, {names.node(node)});
    Append(graph.poses[node], &text);
  }
  for (std::size_t landmark = 0; landmark < graph.landmarks.size(); ++landmark) {
    text.Begin(tags.landmark, {names.landmark(landmark)});
    text.Numbers(graph.landmarks[landmark]);
  }
  for (int node : graph.fixed) text.Begin("FIX", {names.node(node)});
  for (const Constraint<Pose>& constraint : graph.constraints) {
    text.Begin(tags.constraint, {names.node(constraint.from), names.node(constraint.to)});
    Append(constraint.T_from_to, &text);
    text.UpperTriangle(constraint.information);
  }
  for (const LandmarkObservation<Pose>& observation : graph.observations) {
    text.Begin(tags.observation,
               {names.node(observation.node), names.landmark(observation.landmark)});
    if (kHasSensor) text.Id(kSensor);
    text.Numbers(observation.p_node);
    text.UpperTriangle(observation.information);
  }
  return std::move(text).Finish();
}

template std::string FormatG2o(const PoseGraph<SE2>&, const GraphIds&);
template std::string FormatG2o(const PoseGraph<SE3>&, const GraphIds&);

}  // namespace loopgrid
