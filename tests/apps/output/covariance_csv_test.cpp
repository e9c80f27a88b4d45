#include "apps/output/covariance_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace loopgrid {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

TEST(FormatCovarianceCsv, HasTheUpperTriangleRowByRow) {
  Eigen::Matrix3d node;
  node << 1.0, 2.0, 3.0,  //
      2.0, 4.0, 5.0,      //
      3.0, 5.0, 6.0;
  Eigen::Matrix2d landmark;
  landmark << 7.0, 8.0,  //
      8.0, std::numeric_limits<double>::infinity();
  EXPECT_EQ(FormatCovarianceCsv<SE2>({{10, -3}, {42}}, {node, Eigen::Matrix3d::Zero()}, {landmark}),
            "id,cov_xx_m2,cov_xy_m2,cov_xt_m_rad,cov_yy_m2,cov_yt_m_rad,cov_tt_rad2\n"
            "10,1,2,3,4,5,6\n"
            "-3,0,0,0,0,0,0\n"
            "42,7,8,,inf,,\n");
}

TEST(FormatCovarianceCsv, NamesTheColumnsOfASpatialGraph) {
  const std::string text = FormatCovarianceCsv<SE3>(
      {{0}, {1}}, {Marginals<SE3>::Covariance::Identity()}, {Eigen::Matrix3d::Identity()});
  EXPECT_THAT(text, HasSubstr("id,cov_x_x_m2,cov_x_y_m2,cov_x_z_m2,cov_x_qx_m,"));
  EXPECT_THAT(text, HasSubstr(",cov_qy_qy,cov_qy_qz,cov_qz_qz\n0,1,0,0,0,0,0,1,"));
  EXPECT_THAT(text, EndsWith("\n1,1,0,0,,,,1,0,,,,1,,,,,,,,,\n"));
}

TEST(FormatCovarianceCsv, HasEnoughDigitsToCompare) {
  const Eigen::Matrix3d third = Eigen::Matrix3d::Constant(1e-7 / 3.0);
  EXPECT_THAT(FormatCovarianceCsv<SE2>({{0}, {}}, {third}, {}), HasSubstr("3.33333333333e-08"));
}

}  // namespace
}  // namespace loopgrid
