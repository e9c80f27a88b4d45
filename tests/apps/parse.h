#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "apps/cli/command_line.h"
#include "backend/base/error.h"

namespace loopgrid::test_support {

/// Parses the words (without the program's name) as `program` does.
inline Invocation ParseWords(const Program& program, std::vector<const char*> words) {
  words.insert(words.begin(), program.name.c_str());
  return ParseCommandLine(program, static_cast<int>(words.size()), words.data());
}

/// Sets the targets of a command from the words that follow its name.
inline void ParseArguments(const Command& command, std::vector<const char*> words) {
  words.insert(words.begin(), command.name.c_str());
  const Program program{.name = "loopgrid", .version = "1.2.3", .commands = {command}};
  EXPECT_NE(ParseWords(program, std::move(words)).command, nullptr);
}

/// The message of the usage error that the words are; it is one line.
inline std::string UsageErrorOf(const Program& program, const std::vector<const char*>& words) {
  try {
    ParseWords(program, words);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    EXPECT_THAT(error.what(), ::testing::Not(::testing::HasSubstr("\n")));
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

inline std::string UsageErrorOf(const Command& command, std::vector<const char*> words) {
  words.insert(words.begin(), command.name.c_str());
  const Program program{.name = "loopgrid", .version = "1.2.3", .commands = {command}};
  return UsageErrorOf(program, words);
}

}  // namespace loopgrid::test_support
