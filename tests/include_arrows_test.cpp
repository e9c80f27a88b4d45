// Scans every #include of the project against the arrows between its folders:
//
//   apps -> frontend -> mapping -> backend/geometry, backend/base
//                \----> backend -> backend/geometry, backend/base

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace loopgrid {
namespace {

namespace fs = std::filesystem;

/// What the files of a folder may include: the folder's own files always may.
struct Arrow {
  std::string_view folder;
  std::vector<std::string_view> reaches;  // prefixes of quoted includes
};

// The first folder that a path begins with is the one that counts.
const std::vector<Arrow>& Arrows() {
  static const std::vector<Arrow> arrows = {
      {"backend/base/", {}},
      {"backend/geometry/", {"backend/base/"}},
      {"backend/", {}},
      {"mapping/", {"backend/base/", "backend/geometry/"}},
      {"frontend/", {"mapping/", "backend/"}},
      {"apps/", {"frontend/", "mapping/", "backend/"}},
      {"tests/", {"apps/", "frontend/", "mapping/", "backend/"}},
  };
  return arrows;
}

/// Where heavy or high-level libraries may be included.
struct Confinement {
  std::string_view library;              // prefix of an angled include
  std::vector<std::string_view> within;  // folders
  bool in_headers;
};

const std::vector<Confinement>& Confinements() {
  static const std::vector<Confinement> confinements = {
      {"mrpt/", {"frontend/log/", "mapping/", "tests/"}, false},
      {"opencv2/", {"mapping/", "apps/", "tests/"}, false},
      {"amd.h", {"backend/"}, false},
      {"metis.h", {"backend/"}, false},
      {"cholmod.h", {"tests/"}, false},
      {"boost/", {"apps/", "tests/"}, false},
      {"CLI/", {"apps/", "tests/"}, true},
      {"nlohmann/", {"apps/", "tests/"}, true},
      {"ceres/", {"tests/"}, true},
      {"gtest/", {"tests/"}, true},
      {"gmock/", {"tests/"}, true},
  };
  return confinements;
}

bool StartsWithAny(std::string_view text, const std::vector<std::string_view>& prefixes) {
  for (std::string_view prefix : prefixes) {
    if (text.starts_with(prefix)) return true;
  }
  return false;
}

/// The target of an `#include` line with its opening delimiter, as in `"a/b.h` or `<vector`.
std::optional<std::string> IncludeOf(std::string_view line) {
  const auto skip_blanks = [&line] {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  };
  skip_blanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(7);
  skip_blanks();
  if (!line.starts_with('"') && !line.starts_with('<')) return std::nullopt;
  const size_t end = line.find_first_of("\">", 1);
  if (end == std::string_view::npos) return std::nullopt;
  return std::string(line.substr(0, end));
}

/// Why the file at `path` (from the root) may not include `include`; empty if it may.
std::string Objection(std::string_view path, std::string_view include) {
  const std::string_view target = include.substr(1);
  if (include.starts_with('<')) {
    for (const Confinement& rule : Confinements()) {
      if (!target.starts_with(rule.library)) continue;
      if (!StartsWithAny(path, rule.within)) return "this library is kept out of this folder";
      if (!rule.in_headers && path.ends_with(".h")) return "this library is kept out of headers";
    }
    return "";
  }
  for (const Arrow& arrow : Arrows()) {
    if (!path.starts_with(arrow.folder)) continue;
    if (target.starts_with(arrow.folder) || StartsWithAny(target, arrow.reaches)) return "";
    return "no arrow leads there";
  }
  return "this folder is not in the diagram";
}

std::vector<std::string> ObjectionsToFile(const fs::path& root, const std::string& path) {
  std::vector<std::string> objections;
  std::ifstream file(root / path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::optional<std::string> include = IncludeOf(line);
    if (!include) continue;
    std::string objection = Objection(path, *include);
    if (objection.empty() && include->starts_with('"') && !fs::exists(root / include->substr(1))) {
      objection = "no such file from the project's root";
    }
    if (objection.empty()) continue;
    objections.push_back(path + ":" + std::to_string(number) + ": " + line + ": " + objection);
  }
  return objections;
}

std::vector<std::string> SourceFiles(const fs::path& root) {
  std::vector<std::string> files;
  for (const char* folder : {"backend", "mapping", "frontend", "apps", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path extension = entry.path().extension();
      if (extension == ".h" || extension == ".cpp") {
        files.push_back(fs::relative(entry.path(), root).string());
      }
    }
  }
  return files;
}

TEST(IncludeArrows, EveryFileFollowsTheDiagram) {
  const fs::path root = LOOPGRID_SOURCE_DIR;
  const std::vector<std::string> files = SourceFiles(root);
  ASSERT_GT(files.size(), 10u);
  for (const std::string& file : files) {
    for (const std::string& objection : ObjectionsToFile(root, file)) ADD_FAILURE() << objection;
  }
}

TEST(IncludeArrows, LeadDownNeverUp) {
  EXPECT_EQ(Objection("apps/main.cpp", "\"frontend/slam/slam.h"), "");
  EXPECT_EQ(Objection("frontend/slam/slam.h", "\"backend/graph/pose_graph.h"), "");
  EXPECT_EQ(Objection("mapping/grid.h", "\"backend/geometry/se2.h"), "");
  EXPECT_EQ(Objection("backend/graph/pose_graph.h", "\"backend/base/error.h"), "");
  EXPECT_NE(Objection("mapping/grid.h", "\"backend/graph/pose_graph.h"), "");
  EXPECT_NE(Objection("mapping/grid.h", "\"frontend/log/observation/observation.h"), "");
  EXPECT_NE(Objection("backend/graph/pose_graph.h", "\"mapping/grid.h"), "");
  EXPECT_NE(Objection("backend/geometry/se2.h", "\"backend/graph/pose_graph.h"), "");
  EXPECT_NE(Objection("backend/base/error.h", "\"backend/geometry/se2.h"), "");
  EXPECT_NE(Objection("frontend/slam/slam.h", "\"apps/main.h"), "");
  EXPECT_NE(Objection("frontend/slam/slam.h", "\"tests/support/simulator.h"), "");
  EXPECT_NE(Objection("frontend/slam/slam.h", "\"slam_options.h"), "");
}

TEST(IncludeArrows, HeavyLibrariesStayInTheirRooms) {
  EXPECT_EQ(Objection("frontend/log/rawlog/rawlog_reader.cpp", "<mrpt/obs/CRawlog.h"), "");
  EXPECT_NE(Objection("frontend/log/rawlog/rawlog_reader.h", "<mrpt/obs/CRawlog.h"), "");
  EXPECT_NE(Objection("backend/graph/pose_graph.cpp", "<mrpt/poses/CPose2D.h"), "");
  EXPECT_NE(Objection("mapping/map_files.h", "<opencv2/core.hpp"), "");
  EXPECT_NE(Objection("frontend/slam/slam.cpp", "<nlohmann/json.hpp"), "");
}

TEST(IncludeArrows, AreFoundHoweverTheLineIsWritten) {
  EXPECT_EQ(IncludeOf("#include <vector>"), "<vector");
  EXPECT_EQ(IncludeOf("  #  include\t\"a/b.h\"  // why"), "\"a/b.h");
  EXPECT_EQ(IncludeOf("#include"), std::nullopt);
  EXPECT_EQ(IncludeOf("// #include <vector>"), std::nullopt);
  EXPECT_EQ(IncludeOf(""), std::nullopt);
}

}  // namespace
}  // namespace loopgrid
