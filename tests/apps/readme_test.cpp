// The pages (README.md in each folder) agree with the program and with the tree.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "apps/output/closures_csv.h"
#include "apps/run/run_outputs.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace readme_test {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunProgram;
using test_support::TemporaryDirectory;
using ::testing::Contains;
using ::testing::HasSubstr;

const fs::path kRoot = LOOPGRID_SOURCE_DIR;

std::string ReadPage(const std::string& page) { return ReadFile((kRoot / page).string()); }

/// Every README.md of the project, from its root.
std::vector<std::string> Pages() {
  std::vector<std::string> pages = {"README.md"};
  for (const char* folder : {"apps", "backend", "frontend", "logs", "mapping", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (entry.path().filename() != "README.md") continue;
      pages.push_back(fs::relative(entry.path(), kRoot).string());
    }
  }
  return pages;
}

/// The first group of every match.
std::vector<std::string> FindAll(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

/// The part of a page from one heading of the second level to the next.
std::string Section(const std::string& page, const std::string& heading) {
  const std::string text = ReadPage(page);
  const std::size_t begin = text.find("\n## " + heading + "\n");
  EXPECT_NE(begin, std::string::npos) << page << " has no section " << heading;
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find("\n## ", begin + 1) - begin);
}

/// The anchor that GitHub makes of a heading: the part of a link after the #.
std::string AnchorOf(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    if (c == ' ') anchor += '-';
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    if (kept) anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return anchor;
}

std::vector<std::string> AnchorsOf(const fs::path& file) {
  std::vector<std::string> anchors;
  std::istringstream lines(ReadFile(file.string()));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t text = line.find_first_not_of('#');
    if (text == 0 || text == std::string::npos || line[text] != ' ') continue;
    anchors.push_back(AnchorOf(line.substr(text + 1)));
  }
  return anchors;
}

/// The problem with a link of a page; empty if its target exists.
std::string ProblemWithLink(const std::string& page, const std::string& link) {
  if (link.starts_with("http://") || link.starts_with("https://")) return "";
  const std::size_t mark = std::min(link.find('#'), link.size());
  const fs::path from = kRoot / page;
  const fs::path file = mark == 0 ? from : from.parent_path() / link.substr(0, mark);
  if (!fs::exists(file)) return "no such file";
  if (mark == link.size()) return "";
  const std::vector<std::string> anchors = AnchorsOf(file);
  const bool found =
      std::find(anchors.begin(), anchors.end(), link.substr(mark + 1)) != anchors.end();
  return found ? "" : "no such heading";
}

TEST(Readme, EveryLinkAndPictureIsThere) {
  const std::regex link(R"(\]\(([^)\s]+)\))");
  std::size_t count = 0;
  for (const std::string& page : Pages()) {
    for (const std::string& target : FindAll(ReadPage(page), link)) {
      EXPECT_EQ(ProblemWithLink(page, target), "") << page << ": " << target;
      ++count;
    }
  }
  EXPECT_GE(count, 30u);
}

TEST(Readme, ALinkThatLeadsNowhereIsFound) {
  EXPECT_EQ(ProblemWithLink("README.md", "https://example.org/none"), "");
  EXPECT_EQ(ProblemWithLink("README.md", "logs/README.md"), "");
  EXPECT_EQ(ProblemWithLink("apps/README.md", "../backend/README.md#graph-files"), "");
  EXPECT_EQ(ProblemWithLink("README.md", "logs/none.png"), "no such file");
  EXPECT_EQ(ProblemWithLink("apps/README.md", "logs/README.md"), "no such file");
  EXPECT_EQ(ProblemWithLink("README.md", "apps/README.md#none"), "no such heading");
}

TEST(Readme, EveryFileAndFolderThatAPageNamesIsThere) {
  const std::regex path("`((?:apps|backend|frontend|logs|mapping|tests)/[A-Za-z0-9_./-]*)[` ]");
  // Files that logs/fetch.sh downloads, and examples.
  const std::set<std::string> elsewhere = {"logs/intel.clf", "logs/NAME.clf"};
  std::size_t count = 0;
  for (const std::string& page : Pages()) {
    for (const std::string& name : FindAll(ReadPage(page), path)) {
      if (elsewhere.contains(name)) continue;
      EXPECT_TRUE(fs::exists(kRoot / name)) << page << ": " << name;
      ++count;
    }
  }
  EXPECT_GE(count, 30u);
}

TEST(Readme, TheDevelopersPageShowsEveryRoom) {
  const std::string page = ReadPage("tests/README.md");
  for (const char* folder : {"apps", "backend", "frontend", "mapping"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (entry.path().extension() != ".cpp") continue;
      const fs::path room = fs::relative(entry.path().parent_path(), kRoot);
      EXPECT_THAT(page, HasSubstr(fmt::format("\n    {} ", room.string()))) << entry.path();
    }
  }
}

TEST(Readme, PicturesAreSmall) {
  constexpr std::uintmax_t kMostBytes = 150'000;
  for (const auto& entry : fs::directory_iterator(kRoot / "logs")) {
    if (entry.path().extension() != ".png") continue;
    EXPECT_LT(entry.file_size(), kMostBytes) << entry.path();
  }
}

TEST(Readme, ShowsTheEmbeddingProgramThatIsTested) {
  const std::string source = ReadPage("tests/apps/consumer/consumer.cpp");
  EXPECT_THAT(ReadPage("frontend/README.md"), HasSubstr(fmt::format("```cpp\n{}```\n", source)));
}

TEST(Readme, AndHelpNameEveryFileThatARunLeaves) {
  const std::string first_page = ReadPage("README.md");
  const std::string section = Section("apps/README.md", "`loopgrid run`");
  const std::string help = RunProgram({"run", "--help"}).output;
  for (const std::string& name : RunOutputNames()) {
    EXPECT_THAT(first_page, HasSubstr(fmt::format("`{}`", name)));
    EXPECT_THAT(section, HasSubstr(fmt::format("`{}`", name)));
    EXPECT_THAT(help, HasSubstr(name));
  }
}

TEST(Readme, NamesEveryColumnOfClosuresCsv) {
  const std::string section = Section("apps/README.md", "`loopgrid run`");
  const std::string csv = FormatClosuresCsv({});
  std::istringstream header(csv.substr(0, csv.find('\n')));
  for (std::string column; std::getline(header, column, ',');) {
    if (column.starts_with("cov_")) continue;  // the page has a row for all of them
    EXPECT_THAT(section, HasSubstr(fmt::format("`{}`", column)));
  }
  EXPECT_THAT(csv, HasSubstr("cov_xx"));
  EXPECT_THAT(csv, HasSubstr("cov_tt"));
}

/// Checks that a text names every option that a command's help has, and in the first column of its
/// tables no other.
void ExpectToDocumentTheOptionsOf(const char* command, const std::string& text,
                                  std::size_t at_least) {
  const std::vector<std::string> in_help =
      FindAll(RunProgram({command, "--help"}).output, std::regex("\n +(--[a-z-]+)"));
  const std::set<std::string> options(in_help.begin(), in_help.end());
  for (const std::string& option : options) {
    EXPECT_TRUE(std::regex_search(text, std::regex("`" + option + "[` ]"))) << command << option;
  }
  EXPECT_GE(options.size(), at_least);
  for (const std::string& option : FindAll(text, std::regex("\n\\| `(--[a-z-]+)"))) {
    EXPECT_THAT(options, Contains(option)) << command;
  }
}

TEST(Readme, NamesEveryOptionWhereItsCommandIsExplained) {
  const auto section = [](const char* command) {
    return Section("apps/README.md", fmt::format("`loopgrid {}`", command));
  };
  ExpectToDocumentTheOptionsOf("run", section("run"), 6);
  ExpectToDocumentTheOptionsOf("eval", section("eval"), 1);
  ExpectToDocumentTheOptionsOf("optimize", section("optimize"), 16);
  ExpectToDocumentTheOptionsOf("plot", section("plot"), 1);
  ExpectToDocumentTheOptionsOf("replay", section("replay"), 4);
  ExpectToDocumentTheOptionsOf("online", ReadPage("apps/online/README.md"), 16);
}

TEST(Readme, TellsTheExitStatuses) {
  const std::string page = ReadPage("apps/README.md");
  EXPECT_THAT(page, HasSubstr("\n| 2 | wrong usage |"));
  EXPECT_EQ(RunProgram({"run"}).status, 2);
  EXPECT_THAT(page, HasSubstr("\n| 3 | an input cannot be used |"));
  EXPECT_EQ(RunProgram({"eval", "/no/such/file", "/no/such/file"}).status, 3);
}

TEST(Readme, ShowsCommandsThatRun) {
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
  const std::regex example("\n    loopgrid ((?:optimize|plot) [^\n]*)");
  int count = 0;
  for (const std::string& page : Pages()) {
    for (const std::string& command : FindAll(ReadPage(page), example)) {
      std::istringstream words(command);
      const std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
      const ProgramResult result = RunProgram(arguments, [&folder] {
        if (chdir(folder.path().c_str()) != 0) _exit(126);
      });
      EXPECT_EQ(result.status, 0) << page << ": " << command << ": " << result.errors;
      ++count;
    }
  }
  EXPECT_GE(count, 4);
  for (const char* name : {"out.g2o", "out.png", "trace.csv", "covariances.csv", "both.png"}) {
    EXPECT_TRUE(fs::exists(folder.File(name))) << name;
  }
}

}  // namespace
}  // namespace readme_test
}  // namespace loopgrid
