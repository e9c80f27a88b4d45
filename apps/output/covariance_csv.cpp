#include "apps/output/covariance_csv.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace loopgrid {
namespace {

constexpr std::array<std::string_view, 3> kPlanar = {"x", "y", "t"};
constexpr std::array<std::string_view, 6> kSpatial = {"x", "y", "z", "qx", "qy", "qz"};

/// cov_xx_m2, cov_xt_m_rad, cov_x_qx_m: a quaternion has no unit.
template <typename Pose>
std::string ColumnName(int row, int column) {
  constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  constexpr bool kIsPlanar = Pose::kDof == 3;
  const auto part = [](int i) {
    return kIsPlanar ? kPlanar[static_cast<std::size_t>(i % 3)]
                     : kSpatial[static_cast<std::size_t>(i)];
  };
  std::string_view unit = kIsPlanar ? "_m_rad" : "_m";
  if (column < kPoint) unit = "_m2";
  if (row >= kPoint) unit = kIsPlanar ? "_rad2" : "";
  return fmt::format("cov_{}{}{}{}", part(row), kIsPlanar ? "" : "_", part(column), unit);
}

/// For a matrix that may be smaller than that of a node.
template <int kSize, typename Matrix>
void AppendLine(std::int64_t id, const Matrix& covariance, std::string* text) {
  auto out = std::back_inserter(*text);
  fmt::format_to(out, "{}", id);
  for (int row = 0; row < kSize; ++row) {
    for (int column = row; column < kSize; ++column) {
      text->push_back(',');
      if (column < covariance.cols()) fmt::format_to(out, "{:.12g}", covariance(row, column));
    }
  }
  text->push_back('\n');
}

}  // namespace

template <typename Pose>
std::string FormatCovarianceCsv(
    const GraphIds& ids, const std::vector<typename Marginals<Pose>::Covariance>& of_nodes,
    const std::vector<typename Marginals<Pose>::PointCovariance>& of_landmarks) {
  std::string text = "id";
  for (int row = 0; row < Pose::kDof; ++row) {
    for (int column = row; column < Pose::kDof; ++column) {
      text += ',' + ColumnName<Pose>(row, column);
    }
  }
  text += '\n';
  for (std::size_t i = 0; i < of_nodes.size(); ++i) {
    AppendLine<Pose::kDof>(ids.nodes[i], of_nodes[i], &text);
  }
  for (std::size_t i = 0; i < of_landmarks.size(); ++i) {
    AppendLine<Pose::kDof>(ids.landmarks[i], of_landmarks[i], &text);
  }
  return text;
}

#define LOOPGRID_INSTANTIATE(Pose)                                      \
  template std::string FormatCovarianceCsv<Pose>(                       \
      const GraphIds&, const std::vector<Marginals<Pose>::Covariance>&, \
      const std::vector<Marginals<Pose>::PointCovariance>&);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
