#include "apps/output/json_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::TemporaryDirectory;
using ::testing::EndsWith;
using ::testing::ThrowsMessage;

TEST(JsonMembers, AreFoundByNameAndType) {
  const TemporaryDirectory folder;
  const JsonMembers members(folder.Write(
      "a.json", R"({"number": 0.1, "whole": 3, "on": true, "text": "a\nb", "n": null})"));
  EXPECT_EQ(members.Number("number"), 0.1);
  EXPECT_EQ(members.Number("whole"), 3.0);
  EXPECT_TRUE(members.Switch("on"));
  EXPECT_EQ(members.Text("text"), "a\nb");
  const auto expect_damaged = [](const auto& read) {
    EXPECT_THAT(read, ThrowsMessage<Error>(EndsWith("a.json: is damaged")));
  };
  expect_damaged([&] { members.Number("none"); });
  expect_damaged([&] { members.Number("text"); });
  expect_damaged([&] { members.Switch("whole"); });
  expect_damaged([&] { members.Text("n"); });
}

TEST(JsonMembers, WhatIsNoObjectIsDamaged) {
  const TemporaryDirectory folder;
  for (const char* text : {"", "{", "[1]", "3", "{\"a\": 1} x"}) {
    const std::string path = folder.Write("a.json", text);
    EXPECT_THAT([&] { JsonMembers{path}; }, ThrowsMessage<Error>(path + ": is damaged")) << text;
  }
  const std::string none = folder.File("none");
  EXPECT_THAT([&] { JsonMembers{none}; }, ThrowsMessage<Error>(none + ": is damaged"));
}

}  // namespace
}  // namespace loopgrid
