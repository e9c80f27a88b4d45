// Scans every #include of the project against the arrows between its rooms. A room is a folder; it
// may include itself and the rooms that its row names. tests/README.md draws the same figure.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;

/// A folder, and the rooms that its files may include besides its own. A name that ends in `/`
/// stands for the room and all rooms inside it.
struct Room {
  std::string_view folder;
  std::vector<std::string_view> reaches;
};

/// Each room reaches only rooms above it in this table, so there is no cycle.
const std::vector<Room>& Rooms() {
  static const std::vector<Room> rooms = {
      {"backend/base", {}},
      {"backend/geometry", {"backend/base"}},
      {"backend/graph", {"backend/geometry", "backend/base"}},
      {"backend/sparse", {"backend/base"}},
      {"backend/guess", {"backend/graph", "backend/sparse", "backend/geometry", "backend/base"}},
      {"backend/solve", {"backend/graph", "backend/sparse", "backend/geometry", "backend/base"}},
      {"backend/global",
       {"backend/guess", "backend/solve", "backend/graph", "backend/sparse", "backend/geometry",
        "backend/base"}},
      {"backend/files", {"backend/guess", "backend/graph", "backend/geometry", "backend/base"}},

      {"mapping", {"backend/geometry", "backend/base"}},

      {"frontend/log/observation", {"backend/geometry", "backend/base"}},
      {"frontend/log/carmen", {"frontend/log/observation", "backend/geometry", "backend/base"}},
      {"frontend/log/rawlog", {"frontend/log/observation", "backend/geometry", "backend/base"}},
      {"frontend/log",
       {"frontend/log/rawlog", "frontend/log/carmen", "frontend/log/observation",
        "backend/geometry", "backend/base"}},
      {"frontend/evaluation", {"frontend/log/", "backend/geometry", "backend/base"}},
      {"frontend/matching",
       {"frontend/log/observation", "mapping", "backend/geometry", "backend/base"}},
      {"frontend/tracking",
       {"frontend/matching", "frontend/log/observation", "mapping", "backend/graph",
        "backend/geometry", "backend/base"}},
      {"frontend/closing", {"frontend/tracking", "frontend/matching", "mapping", "backend/"}},
      {"frontend/slam",
       {"frontend/closing", "frontend/tracking", "frontend/matching", "frontend/log/observation",
        "mapping", "backend/"}},

      {"apps/cli", {"backend/base"}},
      {"apps/output", {"apps/cli", "frontend/", "mapping", "backend/"}},
      {"apps/settings", {"apps/output", "apps/cli", "frontend/", "mapping", "backend/"}},
      {"apps/net", {"backend/base"}},
      {"apps/modules",
       {"frontend/log/rawlog", "frontend/log/observation", "mapping", "backend/base"}},
      {"apps/live", {"apps/output", "apps/settings", "frontend/", "mapping", "backend/"}},
      {"apps/view",
       {"apps/live", "apps/net", "apps/output", "apps/cli", "frontend/", "mapping", "backend/"}},
      {"apps/eval", {"apps/output", "apps/cli", "frontend/", "backend/"}},
      {"apps/optimize", {"apps/output", "apps/cli", "mapping", "backend/"}},
      {"apps/plot", {"apps/output", "apps/cli", "mapping", "backend/"}},
      {"apps/replay", {"apps/net", "apps/output", "apps/cli", "frontend/log/", "backend/base"}},
      {"apps/run",
       {"apps/output", "apps/settings", "apps/cli", "frontend/", "mapping", "backend/"}},
      {"apps/online/source", {"apps/net", "apps/cli", "backend/base"}},
      {"apps/online/session",
       {"apps/online/source", "apps/net", "apps/output", "apps/settings", "apps/cli",
        "frontend/log/", "backend/base"}},
      {"apps/online",
       {"apps/online/session", "apps/online/source", "apps/run", "apps/live", "apps/net",
        "apps/output", "apps/settings", "apps/cli", "frontend/", "mapping", "backend/"}},
      {"apps", {"apps/", "frontend/", "mapping", "backend/"}},

      {"tests/", {"apps/", "frontend/", "mapping", "backend/"}},
  };
  return rooms;
}

/// Where heavy or high-level libraries may be included.
struct Confinement {
  std::string_view library;              // prefix of an angled include
  std::vector<std::string_view> within;  // prefixes of paths
  bool in_headers;
};

const std::vector<Confinement>& Confinements() {
  static const std::vector<Confinement> confinements = {
      {"mrpt/", {"frontend/log/rawlog/", "tests/"}, false},
      {"opencv2/", {"mapping/", "tests/"}, false},
      {"png.h", {"mapping/", "tests/"}, false},
      {"amd.h", {"backend/sparse/"}, false},
      {"metis.h", {"backend/sparse/"}, false},
      {"cholmod.h", {"tests/"}, false},
      {"boost/", {"apps/", "tests/"}, false},
      {"CLI/", {"apps/cli/command_line.cpp"}, false},
      {"nlohmann/", {"apps/output/json_", "tests/"}, true},
      {"ceres/", {"tests/"}, true},
      {"gtest/", {"tests/"}, true},
      {"gmock/", {"tests/"}, true},
  };
  return confinements;
}

/// The folder that a file is in, without the last slash.
std::string_view FolderOf(std::string_view path) {
  const size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
}

/// Whether `name` stands for `folder`: the room itself, or with a last slash also any room inside
/// it.
bool Names(std::string_view name, std::string_view folder) {
  if (!name.ends_with('/')) return folder == name;
  return folder == name.substr(0, name.size() - 1) || folder.starts_with(name);
}

const Room* RoomOf(std::string_view path) {
  const std::string_view folder = FolderOf(path);
  for (const Room& room : Rooms()) {
    if (Names(room.folder, folder)) return &room;
  }
  return nullptr;
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

std::string ObjectionToLibrary(std::string_view path, std::string_view header) {
  for (const Confinement& rule : Confinements()) {
    if (!header.starts_with(rule.library)) continue;
    const bool inside = std::any_of(rule.within.begin(), rule.within.end(),
                                    [path](std::string_view p) { return path.starts_with(p); });
    if (!inside) return "this library is kept out of this folder";
    if (!rule.in_headers && path.ends_with(".h") && !path.starts_with("tests/")) {
      return "this library is kept out of headers";
    }
  }
  return "";
}

/// Why the file at `path` (from the root) may not include `include`; empty if it may.
std::string Objection(std::string_view path, std::string_view include) {
  const std::string_view target = include.substr(1);
  if (include.starts_with('<')) return ObjectionToLibrary(path, target);
  const Room* room = RoomOf(path);
  if (room == nullptr) return "this folder is not in the diagram";
  const std::string_view folder = FolderOf(target);
  if (Names(room->folder, folder)) return "";
  const auto reached = [folder](std::string_view name) { return Names(name, folder); };
  if (std::any_of(room->reaches.begin(), room->reaches.end(), reached)) return "";
  return "no arrow leads there";
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
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path extension = entry.path().extension();
      if (extension == ".h" || extension == ".cpp") {
        files.push_back(fs::relative(entry.path(), root).string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> ObjectionsToTree(const fs::path& root) {
  std::vector<std::string> objections;
  for (const std::string& file : SourceFiles(root)) {
    for (const std::string& objection : ObjectionsToFile(root, file)) {
      objections.push_back(objection);
    }
  }
  return objections;
}

TEST(IncludeArrows, EveryFileFollowsTheDiagram) {
  const fs::path root = LOOPGRID_SOURCE_DIR;
  ASSERT_GT(SourceFiles(root).size(), 300u);
  for (const std::string& objection : ObjectionsToTree(root)) ADD_FAILURE() << objection;
}

TEST(IncludeArrows, EveryRoomOfTheDiagramHasFiles) {
  std::set<std::string_view> inhabited;
  const std::vector<std::string> files = SourceFiles(LOOPGRID_SOURCE_DIR);
  for (const std::string& file : files) {
    if (const Room* room = RoomOf(file)) inhabited.insert(room->folder);
  }
  for (const Room& room : Rooms()) EXPECT_TRUE(inhabited.contains(room.folder)) << room.folder;
}

TEST(IncludeArrows, OfTheDiagramLeadOnlyToRoomsAboveInTheTable) {
  std::vector<std::string_view> above;
  for (const Room& room : Rooms()) {
    for (std::string_view name : room.reaches) {
      const auto named = [name](std::string_view folder) { return Names(name, folder); };
      EXPECT_TRUE(std::any_of(above.begin(), above.end(), named)) << room.folder << " -> " << name;
    }
    above.push_back(room.folder);
  }
}

TEST(IncludeArrows, AForbiddenIncludeIsReportedWithFileAndLine) {
  const test_support::TemporaryDirectory root;
  fs::create_directories(root.path() / "backend/solve");
  fs::create_directories(root.path() / "frontend/slam");
  std::ofstream(root.path() / "frontend/slam/slam.h") << "#pragma once\n";
  std::ofstream(root.path() / "backend/solve/a.cpp")
      << "#include <vector>\n#include \"frontend/slam/slam.h\"\n#include "
         "\"backend/graph/none.h\"\n";
  const std::vector<std::string> objections = ObjectionsToTree(root.path());
  ASSERT_EQ(objections.size(), 2u);
  EXPECT_TRUE(objections[0].starts_with("backend/solve/a.cpp:2: ")) << objections[0];
  EXPECT_TRUE(objections[1].ends_with("no such file from the project's root")) << objections[1];
}

TEST(IncludeArrows, LeadDownNeverUp) {
  EXPECT_EQ(Objection("apps/main.cpp", "\"frontend/slam/slam.h"), "");
  EXPECT_EQ(Objection("frontend/slam/slam.h", "\"backend/graph/pose_graph.h"), "");
  EXPECT_EQ(Objection("backend/solve/a.h", "\"backend/sparse/ordering.h"), "");
  EXPECT_NE(Objection("backend/sparse/a.h", "\"backend/graph/pose_graph.h"), "");
  EXPECT_NE(Objection("backend/solve/a.h", "\"backend/guess/initial_guess.h"), "");
  EXPECT_NE(Objection("mapping/grid.h", "\"backend/graph/pose_graph.h"), "");
  EXPECT_NE(Objection("apps/view/a.h", "\"apps/online/online_status.h"), "");
  EXPECT_NE(Objection("apps/online/a.h", "\"apps/view/view_server.h"), "");
  EXPECT_NE(Objection("apps/online/source/a.h", "\"apps/online/online_status.h"), "");
  EXPECT_NE(Objection("frontend/slam/slam.h", "\"tests/support/simulator.h"), "");
  EXPECT_NE(Objection("frontend/slam/slam.h", "\"slam_options.h"), "");
  EXPECT_NE(Objection("backend/attic/a.h", "\"backend/base/error.h"), "");
}

TEST(IncludeArrows, HeavyLibrariesStayInTheirRooms) {
  EXPECT_EQ(Objection("frontend/log/rawlog/rawlog_reader.cpp", "<mrpt/obs/CRawlog.h"), "");
  EXPECT_NE(Objection("frontend/log/rawlog/rawlog_reader.h", "<mrpt/obs/CRawlog.h"), "");
  EXPECT_NE(Objection("frontend/log/log_reader.cpp", "<mrpt/obs/CRawlog.h"), "");
  EXPECT_NE(Objection("mapping/map_files.h", "<opencv2/core.hpp"), "");
  EXPECT_NE(Objection("apps/run/run_command.cpp", "<CLI/CLI.hpp"), "");
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
