#include "apps/output/closures_csv.h"

#include <fmt/format.h>

#include <iterator>

namespace loopgrid {

std::string FormatClosuresCsv(const std::vector<Closure>& closures) {
  std::string text =
      "from,to,time,distance_sigmas,score,second_score,denied_share,x,y,theta,"
      "cov_xx,cov_xy,cov_xt,cov_yy,cov_yt,cov_tt,chi2,outcome\n";
  for (const Closure& closure : closures) {
    const SE2& pose = closure.T_from_to;
    const Eigen::Matrix3d& cov = closure.covariance;
    fmt::format_to(std::back_inserter(text),
                   "{},{},{:.6f},{:.3f},{:.4f},{:.4f},{:.3f},{:.4f},{:.4f},{:.5f},"
                   "{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{}\n",
                   closure.from, closure.to, closure.timestamp, closure.distance_sigmas,
                   closure.score, closure.second_score, closure.denied_share, pose.x(), pose.y(),
                   pose.theta(), cov(0, 0), cov(0, 1), cov(0, 2), cov(1, 1), cov(1, 2), cov(2, 2),
                   closure.chi2, ToString(closure.outcome));
  }
  return text;
}

}  // namespace loopgrid
