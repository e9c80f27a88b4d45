#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "apps/run/run_outputs.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid::test_support {

/// report.json without what may differ between two runs on the same lines: times, the log's name.
inline nlohmann::json ReportIn(const std::string& folder) {
  nlohmann::json report = nlohmann::json::parse(ReadFile(folder + "/report.json"));
  EXPECT_EQ(report.erase("timings"), 1u);
  EXPECT_EQ(report["log"].erase("file"), 1u);
  for (nlohmann::json& problem : report["log"]["first_problems"]) {
    const std::string text = problem;  // FILE:LINE: what
    problem = text.substr(text.find(".clf:"));
  }
  return report;
}

/// Expects that two folders have all files of a run, with the same content.
inline void ExpectSameFiles(const std::string& a, const std::string& b) {
  for (const std::string& name : RunOutputNames()) {
    const std::string content = ReadFile(a + "/" + name);
    EXPECT_THAT(content, ::testing::Not(::testing::IsEmpty())) << name;
    if (name == "report.json") continue;
    EXPECT_TRUE(content == ReadFile(b + "/" + name)) << name;
  }
  EXPECT_EQ(ReportIn(a), ReportIn(b));
}

}  // namespace loopgrid::test_support
