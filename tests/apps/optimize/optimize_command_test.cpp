// The command `loopgrid optimize`.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/output/trace_csv.h"
#include "backend/files/graph_file.h"
#include "tests/apps/program.h"
#include "tests/apps/refusal.h"
#include "tests/support/manhattan_world.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::Program;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunProgram;
using test_support::TemporaryDirectory;
using test_support::WriteFile;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;
using namespace std::chrono_literals;
using Arguments = std::vector<std::string>;

// A square drive whose odometry turns too far, and a closure; ids that are not their indices.
constexpr const char* kSquare =
    "VERTEX_SE2 10 0 0 0\n"
    "VERTEX_SE2 20 1 0 1.6\n"
    "VERTEX_SE2 30 1 1.1 -3.1\n"
    "VERTEX_SE2 40 0.1 1 -1.5\n"
    "EDGE_SE2 10 20 1 0 1.6 100 0 0 100 0 400\n"
    "EDGE_SE2 20 30 1 0 1.6 100 0 0 100 0 400\n"
    "EDGE_SE2 30 40 1 0 1.6 100 0 0 100 0 400\n"
    "EDGE_SE2 40 10 1 0 1.5 100 0 0 100 0 400\n";

constexpr const char* kLandmarks =
    "VERTEX_XY 50 2 2\n"
    "VERTEX_XY 60 -1 2\n"
    "EDGE_SE2_XY 10 50 2 2.1 50 0 50\n"
    "EDGE_SE2_XY 20 50 2 -1 50 0 50\n"
    "EDGE_SE2_XY 30 50 -1.1 -1 50 0 50\n"
    "EDGE_SE2_XY 10 60 -1 2.1 50 0 50\n"
    "EDGE_SE2_XY 40 60 -1 -1 50 0 50\n";

// Three poses in space, the last edge of which disagrees.
constexpr const char* kSpace =
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
    "VERTEX_SE3:QUAT 1 1 0 0 0 0 0.1 0.995\n"
    "VERTEX_SE3:QUAT 2 2 0 1 0.1 0 0.2 0.97\n"
    "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0.1 0.994987437 9 0 0 0 0 0 9 0 0 0 0 9 0 0 0 40 0 0 40 0 40\n"
    "EDGE_SE3:QUAT 1 2 1 0 1 0.1 0 0.1 0.989949494 9 0 0 0 0 0 9 0 0 0 0 9 0 0 0 40 0 0 40 0 40\n"
    "EDGE_SE3:QUAT 0 2 2 0.2 1 0 0 0.2 0.979795897 9 0 0 0 0 0 9 0 0 0 0 9 0 0 0 40 0 0 40 0 40\n";

/// The fields of a CSV file, header included.
std::vector<std::vector<std::string>> ReadCsv(const std::string& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(ReadFile(path));
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

class OptimizeCommandTest : public ::testing::Test {
 protected:
  ProgramResult Optimize(Arguments more = {}) const {
    more.insert(more.begin(), {"optimize", graph_});
    return RunProgram(more);
  }

  json OptimizeJson(Arguments more = {}) const {
    more.push_back("--json");
    const ProgramResult result = Optimize(more);
    EXPECT_EQ(result.status, 0) << result.errors;
    return json::parse(result.output);
  }

  void ExpectRefusal(Arguments more, const std::string& reason, int status = 2) const {
    more.insert(more.begin(), {"optimize", graph_});
    test_support::ExpectRefusal(folder_, more, status, reason);
  }

  TemporaryDirectory folder_;
  std::string graph_ = folder_.Write("square.g2o", kSquare);
  std::string out_ = folder_.File("out.g2o");
};

TEST_F(OptimizeCommandTest, WithoutOutputsReportsAndLeavesNothing) {
  const ProgramResult result = Optimize();
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.errors, IsEmpty());
  EXPECT_THAT(result.output, AllOf(HasSubstr("2D, 4 nodes, 4 constraints"), HasSubstr("node 10"),
                                   HasSubstr("3 sequential, 1 closure"), HasSubstr("converged"),
                                   HasSubstr("3 degrees of freedom"), HasSubstr("global optimum"),
                                   HasSubstr("poses in the file")));
  EXPECT_EQ(folder_.Everything(), std::set<std::string>{"square.g2o"});
}

TEST_F(OptimizeCommandTest, LeavesEveryFileThatIsAskedFor) {
  const ProgramResult result =
      Optimize({"--out", out_, "--picture", folder_.File("out.png"), "--trace",
                folder_.File("trace.csv"), "--marginals", folder_.File("cov.csv")});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(folder_.Everything(),
            (std::set<std::string>{"cov.csv", "out.g2o", "out.png", "square.g2o", "trace.csv"}));
  EXPECT_THAT(result.output, AllOf(HasSubstr(out_), HasSubstr("cov.csv")));
  EXPECT_THAT(ReadFile(folder_.File("out.png")), StartsWith("\x89PNG"));
}

TEST_F(OptimizeCommandTest, JsonSaysWhatTheTextSays) {
  const json report = OptimizeJson({"--out", out_});
  EXPECT_EQ(report["graph"]["nodes"], 4);
  EXPECT_EQ(report["graph"]["dimensions"], 2);
  EXPECT_EQ(report["graph"]["held"], json::array({10}));
  EXPECT_EQ(report["graph"]["degrees_of_freedom"], 3);
  EXPECT_EQ(report["termination"], "converged");
  EXPECT_EQ(report["converged"], true);
  EXPECT_EQ(report["optimality"]["is_global"], true);
  EXPECT_EQ(report["files"], json::array({out_}));
  EXPECT_LT(report["error"]["after"], report["error"]["before"]);
  EXPECT_NEAR(report["error"]["after"], report["error"]["chi2_after"], 1e-9);
  EXPECT_EQ(report["start"]["trials"].size(), 1u);
}

TEST_F(OptimizeCommandTest, OptimisingTheResultAgainTakesNoStep) {
  for (const auto& [content, names] : std::vector<std::pair<std::string, Arguments>>{
           {kSquare, {"a.g2o", "a.graph", "a.toro.gz", "a.g2o.gz"}},
           {std::string(kSquare) + kLandmarks, {"b.g2o"}},
           {kSpace, {"c.g2o", "c.g2o.gz", "c.graph"}}}) {
    WriteFile(graph_, content);
    for (const std::string& name : names) {
      const std::string out = folder_.File(name);
      const json first = OptimizeJson({"--out", out, "--tolerance", "1e-12"});
      EXPECT_GT(first["iterations"], 0) << name;
      const ProgramResult again = RunProgram({"optimize", out, "--json"});
      ASSERT_EQ(again.status, 0) << again.errors;
      const json second = json::parse(again.output);
      EXPECT_EQ(second["iterations"], 0) << name;
      EXPECT_EQ(second["converged"], true) << name;
      EXPECT_NEAR(second["error"]["after"], first["error"]["after"], 1e-8) << name;
      EXPECT_EQ(second["graph"]["held"], first["graph"]["held"]) << name;
    }
  }
}

TEST_F(OptimizeCommandTest, EveryMethodAndParametrizationFindsTheOptimum) {
  const double expected = OptimizeJson()["error"]["after"];
  for (const char* method : {"lm", "gn", "dogleg"}) {
    EXPECT_NEAR(OptimizeJson({"--method", method})["error"]["after"], expected, 1e-6) << method;
  }
  for (const char* init : {"none", "spanning-tree", "chordal"}) {
    const json report = OptimizeJson({"--init", init});
    EXPECT_NEAR(report["error"]["after"], expected, 1e-6) << init;
    EXPECT_EQ(report["start"]["used"], init);
    EXPECT_EQ(report["optimality"]["is_global"], true) << init;
  }
  for (const char* form : {"exponential", "euler"}) {
    const json report = OptimizeJson({"--parametrization", form});
    EXPECT_EQ(report["converged"], true) << form;
    EXPECT_EQ(report["optimality"]["is_global"], false) << form;
  }
}

TEST_F(OptimizeCommandTest, RobustLossesLeaveAWrongClosureAside) {
  WriteFile(graph_, std::string(kSquare) + "EDGE_SE2 10 30 7 7 0 100 0 0 100 0 400\n");
  const json plain = OptimizeJson();
  EXPECT_GT(plain["error"]["chi2_after"], 100.0);
  EXPECT_FALSE(plain.contains("robust"));
  for (const char* loss : {"huber", "cauchy", "geman-mcclure", "gnc", "dcs"}) {
    const json report = OptimizeJson({"--loss", loss});
    EXPECT_LT(report["error"]["after"], plain["error"]["after"]) << loss;
    EXPECT_EQ(report["robust"]["constraints"], 2) << loss;
  }
  const json gnc = OptimizeJson({"--loss", "gnc", "--loss-width", "2"});
  EXPECT_EQ(gnc["robust"]["outliers"], 1);
  EXPECT_EQ(gnc["options"]["loss_width"], 2.0);
  EXPECT_EQ(OptimizeJson({"--loss", "gnc", "--robust", "all"})["robust"]["constraints"], 5);
  EXPECT_THAT(Optimize({"--loss", "gnc"}).output, HasSubstr("1 of 2 are off by more than 3 sigma"));
}

TEST_F(OptimizeCommandTest, IterationsThatAreUsedUpAreSaidSoPlainly) {
  const ProgramResult result = Optimize({"--max-iterations", "1", "--tolerance", "0"});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, HasSubstr("iterations used up after 1 iteration"));
  const json none = OptimizeJson({"--max-iterations", "0", "--init", "none"});
  EXPECT_EQ(none["converged"], false);
  EXPECT_EQ(none["error"]["after"], none["error"]["before"]);
}

TEST_F(OptimizeCommandTest, TraceBeginsAtTheStartAndEndsAtTheResult) {
  for (const char* method : {"lm", "dogleg"}) {
    const std::string path = folder_.File("trace.csv");
    const json report = OptimizeJson({"--trace", path, "--method", method, "--init", "none"});
    const auto points = ReadTraceCsv(path);
    ASSERT_EQ(points.size(), report["iterations"].get<std::size_t>() + 1);
    EXPECT_NEAR(points.front().y(), report["error"]["before"], 1e-9);
    EXPECT_NEAR(points.back().y(), report["error"]["after"], 1e-9);
    for (std::size_t i = 1; i < points.size(); ++i) {
      EXPECT_LT(points[i].y(), points[i - 1].y()) << method;
      EXPECT_EQ(points[i].x(), static_cast<double>(i));
    }
    EXPECT_THAT(ReadFile(path), StartsWith("iteration,F,chi2,damping,step,seconds\n"));
  }
}

TEST_F(OptimizeCommandTest, MarginalsHaveALineANodeAndLandmark) {
  WriteFile(graph_, std::string(kSquare) + kLandmarks);
  const std::string path = folder_.File("cov.csv");
  OptimizeJson({"--marginals", path});
  const auto rows = ReadCsv(path);
  ASSERT_THAT(rows, SizeIs(7));
  EXPECT_EQ(rows[0][0], "id");
  EXPECT_THAT(rows[0], SizeIs(7));
  for (std::size_t k = 1; k < 7; ++k) EXPECT_EQ(rows[1][k], "0");  // held
  EXPECT_GT(std::stod(rows[2][1]), 0.0);
  EXPECT_EQ(rows[5][0], "50");
  EXPECT_GT(std::stod(rows[5][1]), 0.0);
  EXPECT_EQ(rows[5][3], "");  // a landmark has no angle
}

TEST_F(OptimizeCommandTest, MarginalsRelativeToANodeAreThoseWithItHeld) {
  const std::string content = std::string(kSquare) + kLandmarks;
  WriteFile(graph_, content + "VERTEX_SE2 70 9 9 0\n");
  const std::string relative = folder_.File("relative.csv");
  OptimizeJson({"--marginals", relative, "--relative-to", "30", "--out", out_, "--tolerance", "0"});
  WriteFile(graph_, ReadFile(out_) + "FIX 30\n");
  const std::string held = folder_.File("held.csv");
  OptimizeJson({"--marginals", held, "--init", "none"});
  const auto actual = ReadCsv(relative);
  const auto expected = ReadCsv(held);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t row = 1; row < actual.size(); ++row) {
    ASSERT_EQ(actual[row][0], expected[row][0]);
    for (std::size_t k = 1; k < actual[row].size(); ++k) {
      if (actual[row][0] == "70") {  // joined to nothing
        EXPECT_THAT(actual[row][k], ::testing::AnyOf("inf", "0"));
      } else if (actual[row][k].empty()) {
        EXPECT_EQ(expected[row][k], "");
      } else {
        EXPECT_NEAR(std::stod(actual[row][k]), std::stod(expected[row][k]), 1e-7);
      }
    }
  }
}

TEST_F(OptimizeCommandTest, PartsAreOptimisedEachAndSaidToBe) {
  WriteFile(graph_, std::string(kSquare) +
                        "VERTEX_SE2 100 0 0 0\nVERTEX_SE2 101 1 0 0\nVERTEX_SE2 102 5 5 0\n"
                        "EDGE_SE2 100 101 2 0 0 1 0 0 1 0 1\nFIX 101\n");
  const json report = OptimizeJson();
  EXPECT_EQ(report["graph"]["components"], 3);
  EXPECT_EQ(report["graph"]["held"], json::array({10, 101, 102}));
  EXPECT_EQ(report["graph"]["fixed_in_file"], 1);
  EXPECT_THAT(Optimize().output, HasSubstr("nodes 10 101 102 (1 fixed in the file; 3 components)"));
}

TEST_F(OptimizeCommandTest, NotesSayWhatWasAcceptedAllTheSame) {
  WriteFile(graph_, std::string(kSquare) + "VERTEX_CAMERA 1 2 3\n");
  ExpectRefusal(Arguments{}, "square.g2o:9: unknown tag 'VERTEX_CAMERA'", 3);
  const json report = OptimizeJson({"--lenient"});
  EXPECT_EQ(report["graph"]["notes"]["unknown_tags"], 1);
  EXPECT_THAT(Optimize({"--lenient"}).output, HasSubstr("square.g2o:9: unknown tag"));
  const std::string all = kSquare;
  WriteFile(graph_, all.substr(all.find("EDGE")));
  EXPECT_EQ(OptimizeJson()["graph"]["notes"]["guessed_nodes"], 4);
  EXPECT_THAT(Optimize().output, HasSubstr("4 nodes got their poses from a spanning tree"));
  WriteFile(graph_, kSpace);
  EXPECT_THAT(Optimize().output, HasSubstr("normalised"));
}

TEST_F(OptimizeCommandTest, DataBesideTheGraphArePassedOverAndCounted) {
  const json plain = OptimizeJson();
  WriteFile(graph_, std::string(kSquare) + "ROBOTLASER1 0 1 2 3\nVERTEX_TAG 4 door\n");
  const json report = OptimizeJson();
  EXPECT_EQ(report["graph"]["notes"]["data_lines"], 2);
  EXPECT_EQ(report["error"], plain["error"]);
  EXPECT_THAT(Optimize().output,
              HasSubstr("2 lines with data that are no part of the graph were passed over"));
}

TEST_F(OptimizeCommandTest, IndefiniteInformationIsRefusedOrWhenLenientMended) {
  WriteFile(graph_, std::string(kSquare) + "EDGE_SE2 10 20 1 0 0 1 2 0 1 0 1\n");
  ExpectRefusal(Arguments{},
                "square.g2o:9: the information matrix between 10 and 20 is not positive "
                "semi-definite: its smallest eigenvalue is -1",
                3);
  EXPECT_EQ(OptimizeJson({"--lenient"})["graph"]["notes"]["indefinite_information"], 1);
  EXPECT_THAT(Optimize({"--lenient"}).output, HasSubstr("1 information matrix was replaced"));
}

TEST_F(OptimizeCommandTest, ResultDoesNotDependOnThreadsButTimings) {
  const auto without_timings = [](json report) {
    EXPECT_EQ(report.erase("timings"), 1u);
    return report;
  };
  const json one = OptimizeJson({"--threads", "1", "--out", out_});
  const std::string bytes = ReadFile(out_);
  EXPECT_EQ(without_timings(OptimizeJson({"--threads", "3", "--out", out_})), without_timings(one));
  EXPECT_EQ(ReadFile(out_), bytes);
}

TEST_F(OptimizeCommandTest, MayReplaceItsOwnInput) {
  const double after = OptimizeJson({"--out", graph_})["error"]["after"];
  EXPECT_NEAR(OptimizeJson()["error"]["before"], after, 1e-9);
}

TEST_F(OptimizeCommandTest, OptionsThatContradictEachOtherAreUsageErrors) {
  ExpectRefusal({"--loss-width", "2"}, "--loss-width without --loss");
  ExpectRefusal({"--robust", "all"}, "--robust without --loss");
  ExpectRefusal({"--relative-to", "10"}, "--relative-to without --marginals");
  ExpectRefusal({"--marginals", out_, "--relative-to", "11"}, "has no such node");
  ExpectRefusal({"--picture", folder_.File("a.jpg")}, "a.jpg: pictures are PNG");
  ExpectRefusal({"--out", out_, "--trace", out_}, "two different outputs would go to this file");
  ExpectRefusal({"--out", ""}, "--out: the name is empty");
  ExpectRefusal({"--method", "newton"}, "--method: ");
  ExpectRefusal({"--init", ""}, "--init: ");
  ExpectRefusal({"--loss", "huber", "--loss-width", "0"}, "--loss-width is 0");
  ExpectRefusal({"--threads", "0"}, "--threads is 0, expected 1 to 1024");
  ExpectRefusal({"--max-iterations", "-1"}, "--max-iterations is -1");
  ExpectRefusal({"--tolerance", "nan"}, "--tolerance is nan");
  WriteFile(graph_, std::string(kSquare) + kLandmarks);
  ExpectRefusal({"--out", folder_.File("out.graph")},
                "out.graph: the TORO format has no landmarks");
}

TEST_F(OptimizeCommandTest, OutputsAreTriedBeforeAnythingIsDone) {
  ExpectRefusal({"--out", out_, "--trace", folder_.File("none/trace.csv")}, "none/trace.csv: ", 4);
  ExpectRefusal({"--out", folder_.File("")}, "is a directory", 4);
  // The covariances do not exist. This is found at the end, and no file is left.
  WriteFile(graph_, "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 0\n");
  ExpectRefusal({"--out", out_, "--marginals", folder_.File("cov.csv")},
                "square.g2o: there are no covariances", 3);
}

TEST_F(OptimizeCommandTest, WhatCannotBeOptimisedIsAnInputError) {
  test_support::ExpectRefusal(folder_, {"optimize", folder_.File("none.g2o")}, 3, "none.g2o: ");
  WriteFile(graph_, "");
  ExpectRefusal(Arguments{}, "square.g2o: ", 3);
  WriteFile(graph_, "EDGE_SE2 0 1 1 0\n");
  ExpectRefusal(Arguments{}, "square.g2o:1: ", 3);
  WriteFile(graph_,
            "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1e200 0 0\n"
            "EDGE_SE2 0 1 1 0 0 1e200 0 0 1e200 0 1e200\n");
  ExpectRefusal({"--init", "none"}, "square.g2o: F is not finite", 3);
  EXPECT_EQ(OptimizeJson({"--init", "chordal"})["error"]["after"], 0.0);
}

TEST_F(OptimizeCommandTest, GraphWithNothingToMoveIsDoneAtOnce) {
  WriteFile(graph_, "VERTEX_SE2 5 1 2 3\n");
  const json report = OptimizeJson({"--out", out_});
  EXPECT_EQ(report["termination"], "nothing to move");
  EXPECT_EQ(report["error"]["after"], 0.0);
  EXPECT_THAT(ReadFile(out_), HasSubstr("VERTEX_SE2 5 1 2 3"));
}

TEST_F(OptimizeCommandTest, InterruptLeavesNothing) {
  WriteGraph(graph_, test_support::ManhattanWorld(20000, 4, 1));
  Program program({"optimize", graph_, "--out", out_, "--trace", folder_.File("trace.csv")});
  const auto begun = [this] { return folder_.Everything().size() > 1; };
  for (int i = 0; i < 6000 && !begun(); ++i) std::this_thread::sleep_for(5ms);
  ASSERT_TRUE(begun()) << "waited half a minute";
  program.Send(SIGINT);
  const ProgramResult result = program.Wait();
  EXPECT_EQ(result.status, 128 + SIGINT);
  EXPECT_THAT(result.output, IsEmpty());
  EXPECT_EQ(folder_.Everything(), std::set<std::string>{"square.g2o"});
}

}  // namespace
}  // namespace loopgrid
