#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/online/wait_until.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid::test_support {

/// Runs `loopgrid online` with a file as its standard input.
inline ProgramResult RunOnline(std::vector<std::string> arguments, const std::string& input,
                               const std::function<void()>& before = {}) {
  arguments.insert(arguments.begin(), "online");
  return RunProgram(arguments, [&] {
    dup2(open(input.c_str(), O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    if (before) before();
  });
}

/// The events in a file so far, complete lines only.
inline std::vector<nlohmann::json> EventsIn(const std::string& path) {
  std::vector<nlohmann::json> events;
  if (!std::filesystem::exists(path)) return events;
  const std::string text = ReadFile(path);
  std::istringstream lines(text.substr(0, text.rfind('\n') + 1));
  for (std::string line; std::getline(lines, line);) {
    events.push_back(nlohmann::json::parse(line));
  }
  return events;
}

/// Waits for an event of a kind whose `field`, if one is named, is at least `value`.
inline std::optional<nlohmann::json> WaitForEvent(const std::string& path, const std::string& kind,
                                                  const std::string& field = "", int value = 0) {
  std::optional<nlohmann::json> found;
  const bool came = WaitUntil([&] {
    for (const nlohmann::json& event : EventsIn(path)) {
      if (event["event"] != kind || (!field.empty() && event[field] < value)) continue;
      found = event;
      return true;
    }
    return false;
  });
  EXPECT_TRUE(came) << "waited a minute for the event " << kind;
  return found;
}

}  // namespace loopgrid::test_support
