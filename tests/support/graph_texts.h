#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "backend/base/error.h"
#include "backend/files/graph_file.h"
#include "tests/support/memory_file.h"

namespace loopgrid::test_support {

/// Reads a text as a graph file.
template <typename Pose>
GraphFile<Pose> ReadGraphText(const std::string& text, GraphNotes* notes = nullptr,
                              bool lenient = false) {
  return ReadGraphOf<Pose>(MemoryFile(text).path(), {.lenient = lenient}, notes);
}

/// The message of the error when a text is read, without the name of the file; empty if there is
/// none.
inline std::string Refusal(const std::string& text) {
  const MemoryFile file(text);
  try {
    ReadGraph(file.path());
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInput);
    const std::string message = error.what();
    EXPECT_EQ(message.rfind(file.path() + ":", 0), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message.substr(std::min(message.size(), file.path().size() + 1));
  }
  return "";
}

/// Expects that good lines followed by a bad one are refused, with the bad one's number and a
/// message that has the given words.
inline void ExpectLinesRefused(const std::string& good,
                               const std::vector<std::pair<std::string, std::string>>& cases) {
  const auto line = 1 + std::count(good.begin(), good.end(), '\n');
  EXPECT_EQ(Refusal(good), "");
  for (const auto& [bad, words] : cases) {
    const std::string message = Refusal(good + bad + "\n");
    EXPECT_EQ(message.rfind(std::to_string(line) + ": ", 0), 0U)
        << bad.substr(0, 80) << " is answered by: " << message;
    EXPECT_THAT(message, ::testing::HasSubstr(words)) << bad.substr(0, 80);
  }
}

}  // namespace loopgrid::test_support
