// README.md keeps up with the program.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "apps/run_outputs.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ReadFile;
using test_support::RunProgram;
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

TEST(Readme, NamesEveryOptionOfRun) {
  const std::string readme = ReadFile(kRoot + "README.md");
  const std::string help = RunProgram({"run", "--help"}).output;
  const std::regex option("--[a-z-]+");
  int options = 0;
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
    if (it->str() == "--help") continue;
    EXPECT_THAT(readme, HasSubstr(fmt::format("`{}", it->str())));
    ++options;
  }
  EXPECT_GT(options, 4);
}

}  // namespace
}  // namespace loopgrid
