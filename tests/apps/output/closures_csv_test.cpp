#include "apps/output/closures_csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

namespace loopgrid {
namespace {

TEST(ClosuresCsv, HasAHeaderEvenWithoutClosures) {
  EXPECT_EQ(FormatClosuresCsv({}),
            "from,to,time,distance_sigmas,score,second_score,denied_share,x,y,theta,"
            "cov_xx,cov_xy,cov_xt,cov_yy,cov_yt,cov_tt,chi2,outcome\n");
}

TEST(ClosuresCsv, HasOneLineForEveryClosureWithAllItsFields) {
  Closure closure;
  closure.from = 3;
  closure.to = 41;
  closure.timestamp = 976052857.375;
  closure.distance_sigmas = 1.5;
  closure.score = 0.75;
  closure.second_score = 0.25;
  closure.denied_share = 0.125;
  closure.T_from_to = SE2(0.5, -0.25, 1.0);
  closure.covariance << 1e-4, 2e-5, 3e-6, 2e-5, 4e-4, 5e-6, 3e-6, 5e-6, 6e-4;
  closure.chi2 = 2.5;
  closure.outcome = ClosureOutcome::kAmbiguous;
  std::istringstream lines(FormatClosuresCsv({Closure(), closure}));
  std::string header;
  std::string first;
  std::string second;
  std::getline(lines, header);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_EQ(second,
            "3,41,976052857.375000,1.500,0.7500,0.2500,0.125,0.5000,-0.2500,1.00000,"
            "0.0001,2e-05,3e-06,0.0004,5e-06,0.0006,2.5,ambiguous");
  EXPECT_EQ(std::count(header.begin(), header.end(), ','),
            std::count(second.begin(), second.end(), ','));
  EXPECT_TRUE(first.ends_with(",pending"));
}

}  // namespace
}  // namespace loopgrid
