#include "frontend/evaluation/relations_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "backend/base/error.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::ThrowsMessage;

TEST(RelationsFile, ReadsRelationsInFileOrder) {
  const MemoryFile file(
      "# t1 t2 x y z roll pitch yaw\n"
      "976052905.167303 976052911.885496 -0.05699 -0.12843 0.5 0.1 0.2 -1.68221\n"
      "20 10 1 2 0 0 0 3\n");
  const auto relations = ReadRelationsFile(file.path());
  ASSERT_EQ(relations.size(), 2U);
  EXPECT_EQ(relations[0].t1, 976052905.167303);
  EXPECT_EQ(relations[0].t2, 976052911.885496);
  EXPECT_EQ(relations[0].T_1_2.coordinates(), Eigen::Vector3d(-0.05699, -0.12843, -1.68221));
  EXPECT_EQ(relations[1].t1, 20.0);
  EXPECT_EQ(relations[1].t2, 10.0);
}

TEST(RelationsFile, RefusesMalformedFilesWithTheLine) {
  const struct {
    const char* content;
    const char* problem;
  } cases[] = {
      {"1 2 0 0 0 0 0 0\n1 2 3\n", ":2: expected 8 numbers, found 3"},
      {"1 2 inf 0 0 0 0 0\n", ":1: field 3 is not a finite number"},
      {"1 2 0 1e9 0 0 0 0\n", ":1: the pose is out of any bounds"},
      {"1 2 0 0 0 0 0 1e9\n", ":1: the pose is out of any bounds"},
      {"", ": holds no relation"},
  };
  for (const auto& [content, problem] : cases) {
    const MemoryFile file(content);
    EXPECT_THAT([&] { ReadRelationsFile(file.path()); },
                ThrowsMessage<Error>(file.path() + problem));
  }
}

}  // namespace
}  // namespace loopgrid
