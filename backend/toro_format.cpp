#include "backend/toro_format.h"

#include <Eigen/Core>
#include <array>

#include "backend/geometry/euler.h"
#include "backend/graph_text.h"

namespace loopgrid {
namespace {

template <typename Pose>
Pose ReadPose(GraphLine* line);

template <>
SE2 ReadPose<SE2>(GraphLine* line) {
  return SE2(line->Numbers<3>());
}

template <>
SE3 ReadPose<SE3>(GraphLine* line) {
  const Eigen::Vector3d translation = line->Numbers<3>();
  return SE3(translation, FromRollPitchYaw(line->Numbers<3>()));
}

template <typename Pose>
typename Constraint<Pose>::Information ReadInformation(GraphLine* line);

template <>
Eigen::Matrix3d ReadInformation<SE2>(GraphLine* line) {
  const Eigen::Matrix<double, 6, 1> I = line->Numbers<6>();  // xx xy yy tt xt yt
  return (Eigen::Matrix3d() << I[0], I[1], I[4], I[1], I[2], I[5], I[4], I[5], I[3]).finished();
}

template <>
Eigen::Matrix<double, 6, 6> ReadInformation<SE3>(GraphLine* line) {
  Eigen::Matrix<double, 6, 6> information = line->UpperTriangle<6>();
  information.rightCols<3>() *= 2.0;
  information.bottomRows<3>() *= 2.0;
  return information;
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
  constraint.information = ReadInformation<Pose>(line);
  line->End();
  line->RequireInformation(constraint.information);
  builder->AddConstraint({from, to, line->number()}, constraint);
}

constexpr const char* kNode2 = "id x y theta";
constexpr const char* kEdge2 = "from to x y theta Ixx Ixy Iyy Itt Ixt Iyt";

constexpr std::array<GraphTag<SE2>, 4> kTags2 = {{
    {"EDGE2", kEdge2, ReadConstraint<SE2>},
    {"VERTEX2", kNode2, ReadNode<SE2>},
    {"EDGE", kEdge2, ReadConstraint<SE2>},
    {"VERTEX", kNode2, ReadNode<SE2>},
}};

constexpr std::array<GraphTag<SE3>, 2> kTags3 = {{
    {"EDGE3", "from to x y z roll pitch yaw I11 I12 ... I66", ReadConstraint<SE3>},
    {"VERTEX3", "id x y z roll pitch yaw", ReadNode<SE3>},
}};

void Append(const SE2& pose, std::string* text) { AppendNumbers(pose.coordinates(), text); }

void Append(const SE3& pose, std::string* text) {
  AppendNumbers(pose.translation(), text);
  AppendNumbers(RollPitchYaw(pose.quaternion()), text);
}

void AppendInformation(const Eigen::Matrix3d& I, std::string* text) {
  AppendNumbers(std::array{I(0, 0), I(0, 1), I(1, 1), I(2, 2), I(0, 2), I(1, 2)}, text);
}

void AppendInformation(Eigen::Matrix<double, 6, 6> information, std::string* text) {
  information.rightCols<3>() *= 0.5;
  information.bottomRows<3>() *= 0.5;
  AppendUpperTriangle(information, text);
}

}  // namespace

template <>
std::span<const GraphTag<SE2>> ToroTags<SE2>() {
  return kTags2;
}

template <>
std::span<const GraphTag<SE3>> ToroTags<SE3>() {
  return kTags3;
}

template <typename Pose>
std::string FormatToro(const PoseGraph<Pose>& graph, const GraphIds& ids) {
  constexpr bool kPlanar = Pose::kDof == 3;
  const GraphNames names(graph.poses.size(), ids);
  std::string text;
  for (std::size_t node = 0; node < graph.poses.size(); ++node) {
    AppendTag(kPlanar ? "VERTEX2" : "VERTEX3", {names.node(node)}, &text);
    Append(graph.poses[node], &text);
    text += '\n';
  }
  AppendFixed(graph.fixed, names, &text);
  for (const Constraint<Pose>& constraint : graph.constraints) {
    AppendTag(kPlanar ? "EDGE2" : "EDGE3", {names.node(constraint.from), names.node(constraint.to)},
              &text);
    Append(constraint.T_from_to, &text);
    AppendInformation(constraint.information, &text);
    text += '\n';
  }
  return text;
}

template std::string FormatToro(const PoseGraph<SE2>&, const GraphIds&);
template std::string FormatToro(const PoseGraph<SE3>&, const GraphIds&);

}  // namespace loopgrid
