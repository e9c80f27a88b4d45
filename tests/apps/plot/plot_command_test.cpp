// The command `loopgrid plot`.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/apps/program.h"
#include "tests/apps/refusal.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ExpectRefusal;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunProgram;
using test_support::TemporaryDirectory;
using test_support::WriteFile;
using ::testing::IsEmpty;
using ::testing::StartsWith;

TEST(PlotCommand, DrawsTracesIntoOnePicture) {
  const TemporaryDirectory folder;
  const std::string a = folder.Write("manifold.csv", "iteration,F\n0,900\n1,20\n2,3\n");
  const std::string b = folder.Write("euler.csv", "iteration,F\n0,900\n1,500\n2,nan\n");
  const std::string picture = folder.File("both.png");
  const ProgramResult result = RunProgram({"plot", a, b, "--out", picture});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, IsEmpty());
  const std::string both = ReadFile(picture);
  EXPECT_THAT(both, StartsWith("\x89PNG"));
  ASSERT_EQ(RunProgram({"plot", a, "--out", picture}).status, 0);
  EXPECT_NE(ReadFile(picture), both);
}

TEST(PlotCommand, TellsTracesOfTheSameNameApart) {
  const TemporaryDirectory folder;
  std::filesystem::create_directory(folder.File("other"));
  const std::string a = folder.Write("trace.csv", "iteration,F\n0,9\n");
  const std::string b = folder.Write("other/trace.csv", "iteration,F\n0,9\n");
  const auto plot = [&](const std::string& first, const std::string& second) {
    EXPECT_EQ(RunProgram({"plot", first, second, "--out", folder.File("p.png")}).status, 0);
    return ReadFile(folder.File("p.png"));
  };
  EXPECT_NE(plot(a, b), plot(b, a));
}

TEST(PlotCommand, RefusesWhatItCannotDraw) {
  const TemporaryDirectory folder;
  const std::string out = folder.File("plot.png");
  const std::string trace = folder.Write("t.csv", "iteration,F\n0,9\n1,x\n");
  ExpectRefusal(folder, {"plot", "--out", out}, 2, "TRACE");
  ExpectRefusal(folder, {"plot", trace}, 2, "--out");
  ExpectRefusal(folder, {"plot", trace, "--out", ""}, 2, "--out: the name is empty");
  ExpectRefusal(folder, {"plot", trace, "--out", folder.File("a.svg")}, 2, "a.svg: pictures are");
  ExpectRefusal(folder, {"plot", folder.File("none.csv"), "--out", out}, 3, "none.csv: ");
  ExpectRefusal(folder, {"plot", trace, "--out", out}, 3, "t.csv:3: 'x' is not a number");
  WriteFile(trace, "VERTEX_SE2 0 0 0 0\n");
  ExpectRefusal(folder, {"plot", trace, "--out", out}, 3, "t.csv:1: no column 'iteration'");
  WriteFile(trace, "iteration,F\n0,9\n");
  ExpectRefusal(folder, {"plot", trace, "--out", folder.File("none/p.png")}, 4, "none/p.png: ");
}

}  // namespace
}  // namespace loopgrid
