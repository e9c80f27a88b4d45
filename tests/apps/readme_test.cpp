// README.md keeps up with the program.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "apps/run/run_outputs.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunProgram;
using test_support::TemporaryDirectory;
using ::testing::HasSubstr;

const std::string kRoot = LOOPGRID_SOURCE_DIR "/";

TEST(Readme, ShowsTheEmbeddingProgramThatIsTested) {
  const std::string source = ReadFile(kRoot + "tests/apps/consumer/consumer.cpp");
  EXPECT_THAT(ReadFile(kRoot + "README.md"), HasSubstr(fmt::format("```cpp\n{}```\n", source)));
}

TEST(Readme, AndHelpNameEveryFileThatARunLeaves) {
  const std::string readme = ReadFile(kRoot + "README.md");
  const std::string help = RunProgram({"run", "--help"}).output;
  for (const std::string& name : RunOutputNames()) {
    EXPECT_THAT(readme, HasSubstr(fmt::format("`{}`", name)));
    EXPECT_THAT(help, HasSubstr(name));
  }
}

/// Checks that the README has every option that a command's help has.
void ExpectReadmeNamesEveryOptionOf(const char* command, int at_least) {
  const std::string readme = ReadFile(kRoot + "README.md");
  const std::string help = RunProgram({command, "--help"}).output;
  const std::regex option("--[a-z-]+");
  int options = 0;
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
    if (it->str() == "--help") continue;
    EXPECT_THAT(readme, HasSubstr(fmt::format("`{}", it->str())));
    ++options;
  }
  EXPECT_GE(options, at_least);
}

TEST(Readme, NamesEveryOptionOfRunOnlineOptimizeAndReplay) {
  ExpectReadmeNamesEveryOptionOf("run", 5);
  ExpectReadmeNamesEveryOptionOf("online", 16);
  ExpectReadmeNamesEveryOptionOf("optimize", 16);
  ExpectReadmeNamesEveryOptionOf("replay", 4);
}

TEST(Readme, ShowsCommandsThatRun) {
  const std::string readme = ReadFile(kRoot + "README.md");
  const TemporaryDirectory folder;
  const std::string planar =
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0.1 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
  const std::string spatial =
      "VERTEX3 0 0 0 0 0 0 0\nVERTEX3 1 1 0.1 0 0 0 0.1\n"
      "EDGE3 0 1 1 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n";
  folder.Write("sphere2500.g2o", spatial);
  folder.Write("sphere-mednoise.graph", spatial);
  folder.Write("intel.g2o", planar);
  folder.Write("manifold.csv", "iteration,F\n0,9\n");
  folder.Write("euler.csv", "iteration,F\n0,9\n1,8\n");
  const std::regex example("\n    loopgrid ((optimize|plot) .*)");
  int count = 0;
  for (std::sregex_iterator it(readme.begin(), readme.end(), example), end; it != end; ++it) {
    const std::string command = (*it)[1];
    std::istringstream words(command);
    const std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
    const ProgramResult result = RunProgram(arguments, [&folder] {
      if (chdir(folder.path().c_str()) != 0) _exit(126);
    });
    EXPECT_EQ(result.status, 0) << command << ": " << result.errors;
    ++count;
  }
  EXPECT_GE(count, 4);
  for (const char* name : {"out.g2o", "out.png", "trace.csv", "covariances.csv", "both.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.File(name))) << name;
  }
}

}  // namespace
}  // namespace loopgrid
