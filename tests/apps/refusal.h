#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tests/apps/program.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid::test_support {

/// Expects that the program refuses the arguments: one line on standard error, nothing else, and
/// the folder as it was.
inline void ExpectRefusal(const TemporaryDirectory& folder,
                          const std::vector<std::string>& arguments, int status,
                          const std::string& reason, const std::function<void()>& before = {}) {
  const std::set<std::string> found = folder.Everything();
  const ProgramResult result = RunProgram(arguments, before);
  EXPECT_EQ(result.status, status) << result.errors;
  EXPECT_THAT(result.output, ::testing::IsEmpty());
  EXPECT_THAT(result.errors,
              ::testing::AllOf(::testing::StartsWith("loopgrid: "), ::testing::EndsWith("\n"),
                               ::testing::HasSubstr(reason)));
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_EQ(folder.Everything(), found);
}

}  // namespace loopgrid::test_support
