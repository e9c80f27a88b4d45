#include "backend/files/toro_format.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>

#include "backend/files/graph_text.h"
#include "backend/geometry/euler.h"

namespace loopgrid {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The derivative of (roll, pitch, yaw) by the vector part of a quaternion with w >= 0: as g2o
/// takes it up to about 64 degrees; that of the identity beyond, where g2o's becomes lopsided and
/// in the end singular.
///
/// g2o changes the vector part v and leaves w, takes the rotation matrix, and from that a
/// quaternion again: (s, w v / s) with s^2 = 1 - v^2. With k = w^2 / s^2, which is 1 at the
/// measurement, this makes roll = atan2(2 (w x + k y z), 1 - 2 k (x^2 + y^2)), and so on.
Eigen::Matrix3d AnglesByVectorPart(const Eigen::Quaterniond& q) {
  constexpr double kSmallestW = 0.85;
  const double w = q.w();
  if (w < kSmallestW) return 2.0 * Eigen::Matrix3d::Identity();
  using Row = Eigen::RowVector3d;
  const double x = q.x();
  const double y = q.y();
  const double z = q.z();
  const Row dk = (2.0 / (w * w)) * q.vec().transpose();
  const double cos_roll = 1.0 - 2.0 * (x * x + y * y);  // times cos(pitch), as the next three
  const double sin_roll = 2.0 * (w * x + y * z);
  const double cos_yaw = 1.0 - 2.0 * (y * y + z * z);
  const double sin_yaw = 2.0 * (w * z + x * y);
  const double cos_pitch = std::hypot(cos_roll, sin_roll);
  const Row d_cos_roll = -2.0 * (Row(2.0 * x, 2.0 * y, 0.0) + (x * x + y * y) * dk);
  const Row d_sin_roll = 2.0 * (Row(w, z, y) + y * z * dk);
  const Row d_sin_pitch = 2.0 * (Row(-z, w, -x) - x * z * dk);
  const Row d_cos_yaw = -2.0 * (Row(0.0, 2.0 * y, 2.0 * z) + (y * y + z * z) * dk);
  const Row d_sin_yaw = 2.0 * (Row(y, x, w) + x * y * dk);
  Eigen::Matrix3d J;
  J << (cos_roll * d_sin_roll - sin_roll * d_cos_roll) / (cos_pitch * cos_pitch),
      d_sin_pitch / cos_pitch,
      (cos_yaw * d_sin_yaw - sin_yaw * d_cos_yaw) / (cos_pitch * cos_pitch);
  return J;
}

/// The information matrix in other coordinates of the rotation; J: the old ones by the new ones.
Matrix6d Transform(const Matrix6d& information, const Eigen::Matrix3d& J) {
  Matrix6d transformed = information;
  transformed.topRightCorner<3, 3>() = information.topRightCorner<3, 3>() * J;
  transformed.bottomRightCorner<3, 3>() = J.transpose() * information.bottomRightCorner<3, 3>() * J;
  transformed.triangularView<Eigen::StrictlyLower>() = transformed.transpose();
  return transformed;
}

template <typename Pose>
Pose ReadToroPose(GraphLine* line);

template <>
SE2 ReadToroPose<SE2>(GraphLine* line) {
  return SE2(line->Numbers<3>());
}

template <>
SE3 ReadToroPose<SE3>(GraphLine* line) {
  const Eigen::Vector3d translation = line->Numbers<3>();
  return SE3(translation, FromRollPitchYaw(line->Numbers<3>()));
}

template <typename Pose>
typename Constraint<Pose>::Information ReadInformation(GraphLine* line, const Pose& T_from_to);

template <>
Eigen::Matrix3d ReadInformation<SE2>(GraphLine* line, const SE2& /*T_from_to*/) {
  const Eigen::Matrix<double, 6, 1> I = line->Numbers<6>();  // xx xy yy tt xt yt
  return (Eigen::Matrix3d() << I[0], I[1], I[4], I[1], I[2], I[5], I[4], I[5], I[3]).finished();
}

template <>
Matrix6d ReadInformation<SE3>(GraphLine* line, const SE3& T_from_to) {
  return Transform(line->UpperTriangle<6>(), AnglesByVectorPart(T_from_to.quaternion()));
}

template <typename Pose>
void ReadToroNode(GraphLine* line, GraphBuilder<Pose>* builder) {
  const std::int64_t id = line->Id();
  const Pose pose = ReadToroPose<Pose>(line);
  line->End();
  builder->AddNode({id, line->number()}, pose);
}

template <typename Pose>
void ReadToroConstraint(GraphLine* line, GraphBuilder<Pose>* builder) {
  const std::int64_t from = line->Id();
  const std::int64_t to = line->Id();
  Constraint<Pose> constraint;
  constraint.T_from_to = ReadToroPose<Pose>(line);
  constraint.information = ReadInformation<Pose>(line, constraint.T_from_to);
  line->End();
  line->RequireInformation(from, to, &constraint.information);
  builder->AddConstraint({from, to, line->number()}, constraint);
}

constexpr const char* kNode2 = "id x y theta";
constexpr const char* kEdge2 = "from to x y theta Ixx Ixy Iyy Itt Ixt Iyt";

constexpr std::array<GraphTag<SE2>, 4> kToroTags2 = {{
    {"EDGE2", kEdge2, ReadToroConstraint<SE2>},
    {"VERTEX2", kNode2, ReadToroNode<SE2>},
    {"EDGE", kEdge2, ReadToroConstraint<SE2>},
    {"VERTEX", kNode2, ReadToroNode<SE2>},
}};

constexpr std::array<GraphTag<SE3>, 2> kToroTags3 = {{
    {"EDGE3", "from to x y z roll pitch yaw I11 I12 ... I66", ReadToroConstraint<SE3>},
    {"VERTEX3", "id x y z roll pitch yaw", ReadToroNode<SE3>},
}};

void AppendToro(const SE2& pose, GraphText* text) { text->Numbers(pose.coordinates()); }

void AppendToro(const SE3& pose, GraphText* text) {
  text->Numbers(pose.translation());
  text->Numbers(RollPitchYaw(pose.quaternion()));
}

void AppendInformation(const Constraint<SE2>& constraint, GraphText* text) {
  const Eigen::Matrix3d& I = constraint.information;
  text->Numbers(std::array{I(0, 0), I(0, 1), I(1, 1), I(2, 2), I(0, 2), I(1, 2)});
}

void AppendInformation(const Constraint<SE3>& constraint, GraphText* text) {
  const Eigen::Matrix3d J = AnglesByVectorPart(constraint.T_from_to.quaternion());
  text->UpperTriangle(Transform(constraint.information, J.inverse()));
}

}  // namespace

template <>
std::span<const GraphTag<SE2>> ToroTags<SE2>() {
  return kToroTags2;
}

template <>
std::span<const GraphTag<SE3>> ToroTags<SE3>() {
  return kToroTags3;
}

template <typename Pose>
std::string FormatToro(const PoseGraph<Pose>& graph, const GraphIds& ids) {
  constexpr bool kPlanar = Pose::kDof == 3;
  const GraphNames names(graph.poses.size(), ids);
  GraphText text;
  for (std::size_t node = 0; node < graph.poses.size(); ++node) {
    text.Begin(kPlanar ? "VERTEX2" : "VERTEX3", {names.node(node)});
    AppendToro(graph.poses[node], &text);
  }
  for (int node : graph.fixed) text.Begin("FIX", {names.node(node)});
  for (const Constraint<Pose>& constraint : graph.constraints) {
    text.Begin(kPlanar ? "EDGE2" : "EDGE3",
               {names.node(constraint.from), names.node(constraint.to)});
    AppendToro(constraint.T_from_to, &text);
    AppendInformation(constraint, &text);
  }
  return std::move(text).Finish();
}

template std::string FormatToro(const PoseGraph<SE2>&, const GraphIds&);
template std::string FormatToro(const PoseGraph<SE3>&, const GraphIds&);

}  // namespace loopgrid
