#include "apps/modules/module.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/apps/program.h"
#include "tests/apps/refusal.h"
#include "tests/apps/small_log.h"
#include "tests/support/recordings.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramResult;
using test_support::RunProgram;
using test_support::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::ThrowsMessage;

const std::string kRawlog =
    test_support::MrptDataset("2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog");

/// A copy of the program without its modules.
class LonelyProgram {
 public:
  LonelyProgram() { fs::copy_file(LOOPGRID_PROGRAM, folder_.File("loopgrid")); }

  /// `input` is a file for its standard input.
  ProgramResult Run(const std::vector<std::string>& arguments,
                    const std::string& input = "/dev/null") const {
    return RunProgram(arguments, [this, arguments, input] {
      dup2(open(input.c_str(), O_RDONLY | O_CLOEXEC), STDIN_FILENO);
      Instead(arguments)();
    });
  }

  void ExpectRefusal(const TemporaryDirectory& folder, const std::vector<std::string>& arguments,
                     int status, const std::string& reason) const {
    test_support::ExpectRefusal(folder, arguments, status, reason, Instead(arguments));
  }

 private:
  /// Runs in the child, and never returns to what it would have run.
  std::function<void()> Instead(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), folder_.File("loopgrid"));
    return [arguments]() mutable {
      std::vector<char*> pointers;
      for (std::string& argument : arguments) pointers.push_back(argument.data());
      pointers.push_back(nullptr);
      execv(pointers[0], pointers.data());
      _exit(127);
    };
  }

  TemporaryDirectory folder_;
};

TEST(Module, AMissingOneIsNamedWithItsPurpose) {
  EXPECT_THAT([] { LoadFromModule("loopgrid-nothing.so", "f", "does nothing"); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("cannot load loopgrid-nothing.so, which does nothing: "),
                        HasSubstr("No such file"))));
}

TEST(Module, AForeignLibraryIsRefused) {
  EXPECT_THAT([] { LoadFromModule("libm.so.6", "sin", "computes"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("loopgrid_module_version")));
}

TEST(Module, AnotherVersionIsRefused) {
  EXPECT_THAT(
      [] { LoadFromModule(LOOPGRID_OLD_MODULE, "loopgrid_answer", "answers"); },
      ThrowsMessage<std::runtime_error>(HasSubstr("it is of version 0.0.1, this program of ")));
}

TEST(Modules, AreNotLoadedAtTheStart) {
  const ProgramResult result =
      RunProgram({"--version"}, [] { setenv("LD_TRACE_LOADED_OBJECTS", "1", 1); });
  EXPECT_THAT(result.output, HasSubstr("libstdc++"));
  for (const char* name : {"opencv", "mrpt", "X11", "gdal", "tbb", "blas"}) {
    EXPECT_THAT(result.output, Not(HasSubstr(name)));
  }
}

TEST(Modules, AreNotNeededUntilTheirPartIs) {
  const LonelyProgram program;
  EXPECT_EQ(program.Run({"--version"}).status, 0);
  const TemporaryDirectory folder;
  const std::string trace = folder.Write("trace.csv", "iteration,F\n0,9\n");
  program.ExpectRefusal(folder, {"plot", trace, "--out", folder.File("plot.png")}, 4,
                        "cannot load loopgrid-drawing.so, which draws the pictures: ");
  program.ExpectRefusal(folder, {"run", kRawlog, "--out", folder.File("out")}, 3,
                        "one_loop_only.rawlog: cannot load loopgrid-rawlog.so, which reads MRPT "
                        "rawlogs: ");
}

TEST(Modules, ARunWithoutTheDrawingModuleLeavesThePicturesOutWithANote) {
  const LonelyProgram program;
  const TemporaryDirectory folder;
  const std::string log = folder.Write("room.clf", test_support::SmallLog(20));
  for (const std::string command : {"run", "online"}) {
    SCOPED_TRACE(command);
    const std::string out = folder.File(command);
    std::vector<std::string> arguments = {command, "--out", out, "--quiet"};
    if (command == "run") arguments.push_back(log);
    const ProgramResult result = program.Run(arguments, log);
    EXPECT_EQ(result.status, 0) << result.errors;
    for (const char* name : {"graph.png", "uncertainty.png"}) {
      const std::string note =
          std::string(name) +
          " is left out: cannot load loopgrid-drawing.so, which draws the pictures";
      EXPECT_THAT(result.errors, HasSubstr("note: " + note));
      EXPECT_THAT(test_support::ReadFile(out + "/report.json"), HasSubstr(note));
      EXPECT_FALSE(fs::exists(out + "/" + name)) << name;
    }
    for (const char* name : {"trajectory.tum", "graph.g2o", "corrected.clf", "closures.csv",
                             "map.png", "map.pgm", "map.yaml"}) {
      EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
    }
  }
}

TEST(Modules, AnOptimisationWithAPictureIsRefusedBeforeItReadsTheGraphIfNoneCanBeDrawn) {
  const LonelyProgram program;
  const TemporaryDirectory folder;
  // The graph is not there, but that is not what is reported.
  program.ExpectRefusal(folder,
                        {"optimize", folder.File("none.g2o"), "--out", folder.File("out.g2o"),
                         "--picture", folder.File("graph.png")},
                        4, "cannot load loopgrid-drawing.so, which draws the pictures: ");
}

TEST(Modules, BelongToTheProgramWhereItWasBuilt) {
  const TemporaryDirectory folder;
  const std::string trace = folder.Write("trace.csv", "iteration,F\n0,9\n");
  EXPECT_THAT(RunProgram({"plot", trace, "--out", folder.File("plot.png")}).errors, IsEmpty());
}

}  // namespace
}  // namespace loopgrid
