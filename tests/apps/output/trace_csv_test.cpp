#include "apps/output/trace_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::TemporaryDirectory;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(FormatTraceCsv, HasAHeaderAndALineAStep) {
  const std::string text =
      FormatTraceCsv({{1234.5, 1234.5, 0.0, 0.0, 0.0}, {727.149472123456, 727.0, 1e-5, 2.5, 0.25}});
  EXPECT_EQ(text,
            "iteration,F,chi2,damping,step,seconds\n"
            "0,1234.5,1234.5,0,0,0.000000\n"
            "1,727.149472123456,727,1e-05,2.5,0.250000\n");
}

TEST(ReadTraceCsv, ReadsWhatFormatTraceCsvWrites) {
  const TemporaryDirectory folder;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto points = ReadTraceCsv(
      folder.Write("trace.csv", FormatTraceCsv({{1e8, 1e8, 0.0, 0.0, 0.0},
                                                {1.0 / 3.0, 0.5, 0.0, 1.0, 1.0},
                                                {kInfinity, kInfinity, 0.0, 1.0, 1.0},
                                                {std::nan(""), std::nan(""), 0.0, 1.0, 1.0}})));
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[0], Eigen::Vector2d(0.0, 1e8));
  EXPECT_NEAR(points[1].y(), 1.0 / 3.0, 1e-15);
  EXPECT_EQ(points[2], Eigen::Vector2d(2.0, kInfinity));
  EXPECT_TRUE(std::isnan(points[3].y()));
}

TEST(ReadTraceCsv, FindsColumnsByNameAndPassesOverEmptyLines) {
  const TemporaryDirectory folder;
  const auto points =
      ReadTraceCsv(folder.Write("t", "solver, F ,iteration\r\nmine, 2.5 ,0\r\n\r\nmine,1.5,1\r\n"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1], Eigen::Vector2d(1.0, 1.5));
}

TEST(ReadTraceCsv, RefusesWhatIsNoTraceWithFileAndLine) {
  const TemporaryDirectory folder;
  const auto refuse = [&folder](const std::string& content, const std::string& where,
                                const std::string& reason) {
    const std::string path = folder.Write("t.csv", content);
    try {
      ReadTraceCsv(path);
      ADD_FAILURE() << content;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInput);
      EXPECT_THAT(error.what(), StartsWith(path + where));
      EXPECT_THAT(error.what(), HasSubstr(reason));
    }
  };
  refuse("", ": ", "empty");
  refuse("\n", ":1: ", "'iteration'");
  refuse("VERTEX_SE2 0 0 0 0\n", ":1: ", "no column 'iteration'");
  refuse("iteration,error\n0,1\n", ":1: ", "no column 'F'");
  refuse("iteration,F\n", ": ", "no iteration");
  refuse("iteration,F\n0,1\n1\n", ":3: ", "1 fields, expected 2");
  refuse("iteration,F\n0,1\n1,2,3\n", ":3: ", "3 fields, expected 2");
  refuse("iteration,F\n0,low\n", ":2: ", "'low' is not a number");
  refuse("iteration,F\n0,\n", ":2: ", "'' is not a number");
  refuse("iteration,F\ninf,1\n", ":2: ", "'inf' is not a number, expected one for 'iteration'");
  refuse("iteration,F\n0,1e999\n", ":2: ", "'1e999'");
}

}  // namespace
}  // namespace loopgrid
