// The program on whole recordings, with the accuracy that is required there. Real recordings are
// not part of the project. The environment variable LOOPGRID_DATA names their folder.

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "tests/apps/program.h"
#include "tests/support/recordings.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::MrptDataset;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunProgram;
using test_support::TemporaryDirectory;

struct Recording {
  const char* log;
  int scans;
  const char* reference;    // a trajectory with errors of a few decimetres
  double most_rms;          // metres from the reference, after alignment
  const char* relations;    // empty if there are none
  double most_translation;  // mean of the exact relations' errors, metres
  double most_rotation;     // the same, degrees
};

std::ostream& operator<<(std::ostream& stream, const Recording& recording) {
  return stream << recording.log;
}

const Recording kRecordings[] = {
    {"intel.clf", 8946, "intel.reference.tum", 0.5, "intel-exact.relations", 0.035, 0.8},
    {"killian.clf", 3873, "killian.reference.tum", 1.5, "killian.relations", 0.06, 0.8},
    {"intel-every5.rawlog", 2726, "", 0.0, "", 0.0, 0.0},
    {"aces.clf", 440, "aces.reference.tum", 0.5, "", 0.0, 0.0},
    {"fhw.clf", 488, "fhw.reference.tum", 0.5, "", 0.0, 0.0},
    {"seattle.clf", 241, "seattle.reference.tum", 0.5, "", 0.0, 0.0},
    {"acapulco.clf", 861, "acapulco.reference.tum", 0.5, "", 0.0, 0.0},
};

class RecordingTest : public ::testing::TestWithParam<Recording> {
 protected:
  /// What `eval` says about the trajectory of the run.
  json Evaluate(const std::string& reference) const {
    const ProgramResult result =
        RunProgram({"eval", folder_.File("out/trajectory.tum"), reference, "--json"});
    EXPECT_EQ(result.status, 0) << result.errors;
    return json::parse(result.output);
  }

  TemporaryDirectory folder_;
};

TEST_P(RecordingTest, IsMappedWellWithDefaults) {
  const Recording& recording = GetParam();
  LOOPGRID_REQUIRE_RECORDING(log, std::string("logs/") + recording.log);
  const std::string logs = std::filesystem::path(log).parent_path().string() + "/";

  const ProgramResult run = RunProgram({"run", log, "--out", folder_.File("out")});
  ASSERT_EQ(run.status, 0) << run.errors;
  const json report = json::parse(ReadFile(folder_.File("out/report.json")));
  EXPECT_EQ(report["scans"], recording.scans);
  EXPECT_LT(report["timings"]["peak_memory_mb"], 300.0);

  if (*recording.reference != '\0') {
    const json errors = Evaluate(logs + recording.reference);
    EXPECT_LE(errors["translation_m"]["rms"], recording.most_rms);
  }
  if (*recording.relations != '\0') {
    const json exact = Evaluate(logs + recording.relations)["exact"];
    EXPECT_LE(exact["translation_m"]["mean"], recording.most_translation);
    EXPECT_LE(exact["rotation_deg"]["mean"], recording.most_rotation);
  }
}

std::string NameOf(const ::testing::TestParamInfo<Recording>& info) {
  std::string name = info.param.log;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, RecordingTest, ::testing::ValuesIn(kRecordings), NameOf);

class SimulatedOffice : public ::testing::Test {
 protected:
  /// Maps a log to a folder; returns the report.
  json Map(const std::string& log, const std::string& out) const {
    const ProgramResult run = RunProgram({"run", log, "--out", folder_.File(out)});
    EXPECT_EQ(run.status, 0) << run.errors;
    return json::parse(ReadFile(folder_.File(out + "/report.json")));
  }

  std::string log_ = LOOPGRID_SOURCE_DIR "/logs/simulated-office.clf.gz";
  std::string truth_ = LOOPGRID_SOURCE_DIR "/logs/simulated-office.tum";
  TemporaryDirectory folder_;
};

TEST_F(SimulatedOffice, IsMappedToCentimetres) {
  const json report = Map(log_, "out");
  EXPECT_EQ(report["log"]["malformed"], 0);
  EXPECT_GT(report["closures"]["accepted"], 10);
  const ProgramResult eval =
      RunProgram({"eval", folder_.File("out/trajectory.tum"), truth_, "--json"});
  ASSERT_EQ(eval.status, 0) << eval.errors;
  const json errors = json::parse(eval.output);
  EXPECT_EQ(errors["count"], report["scans"]);
  EXPECT_LE(errors["translation_m"]["rms"], 0.015);
  EXPECT_LE(errors["rotation_deg"]["rms"], 0.15);
}

TEST_F(SimulatedOffice, GivesTheSameBytesTwice) {
  Map(log_, "a");
  Map(log_, "b");
  for (const auto& entry : std::filesystem::directory_iterator(folder_.File("a"))) {
    const std::string name = entry.path().filename();
    if (name == "report.json") continue;
    EXPECT_TRUE(ReadFile(entry.path()) == ReadFile(folder_.File("b/" + name))) << name;
  }
}

TEST_F(SimulatedOffice, CorrectedLogIsALogOfTheSameScans) {
  const json report = Map(log_, "out");
  const json again = Map(folder_.File("out/corrected.clf"), "again");
  EXPECT_EQ(again["scans"], report["scans"]);
  EXPECT_EQ(again["log"]["malformed"], 0);
}

TEST(DebianRecording, IsMappedWithDefaults) {
  const std::string log = MrptDataset("2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog");
  if (!std::filesystem::exists(log)) GTEST_SKIP() << "mrpt-common is not installed";
  const TemporaryDirectory folder;
  const ProgramResult run = RunProgram({"run", log, "--out", folder.File("out")});
  ASSERT_EQ(run.status, 0) << run.errors;
  const json report = json::parse(ReadFile(folder.File("out/report.json")));
  EXPECT_EQ(report["scans"], 225);
  EXPECT_GT(report["closures"]["accepted"], 0);
}

}  // namespace
}  // namespace loopgrid
