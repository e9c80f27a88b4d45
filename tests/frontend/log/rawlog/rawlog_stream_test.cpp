#include "frontend/log/rawlog/rawlog_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "backend/base/error.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

bool IsKnown(const std::string& class_name) { return class_name != "mrpt::obs::CNoSuchClass"; }

// Reads the pieces one after the other, as MRPT would.
void ReadPieces(const std::vector<std::string>& pieces) {
  std::string whole;
  for (const std::string& piece : pieces) whole += piece;
  const MemoryFile file(whole);
  RawlogStream stream(InputFile(file.path()), IsKnown);
  for (const std::string& piece : pieces) {
    std::string buffer(piece.size(), '\0');
    stream.Read(buffer.data(), buffer.size());
    EXPECT_EQ(buffer, piece);
  }
}

std::string Header(const std::string& name) {
  return std::string(1, static_cast<char>(0x80U | name.size()));
}

const std::string kScan = "mrpt::obs::CObservation2DRangeScan";
const std::string kMovement = "mrpt::obs::CActionRobotMovement2D";
const std::string kPose = "mrpt::poses::CPose3D";
const std::string kVersion = "\x07";
const std::string kEnd = "\x88";
const std::string kHugeWord = "\xff\xff\xff\xff";
const std::string kOne("\x01\0\0\0", 4);
const std::string kZero(4, '\0');

TEST(RawlogStream, RefusesToComeUpShort) {
  const MemoryFile file("abc");
  RawlogStream stream(InputFile(file.path()), IsKnown);
  char bytes[4];
  EXPECT_THAT([&] { stream.Read(bytes, 4); },
              ThrowsMessage<Error>(file.path() + ": ends in the middle of an object"));
  EXPECT_EQ(stream.failure(), file.path() + ": ends in the middle of an object");
}

TEST(RawlogStream, RefusesClassesThatAreNotKnown) {
  const std::string unknown = "mrpt::obs::CNoSuchClass";
  EXPECT_THAT(
      [&] {
        ReadPieces({Header(unknown), unknown});
      },
      ThrowsMessage<Error>(HasSubstr("the class " + unknown + ", which is not known")));
}

TEST(RawlogStream, RefusesAScanThatClaimsAbsurdlyManyReadings) {
  const auto scan = [](const std::string& count) {
    return std::vector<std::string>{Header(kScan), kScan, kVersion, kHugeWord,  "\x01", kHugeWord,
                                    Header(kPose), kPose, kVersion, "12345678", kEnd,   count};
  };
  EXPECT_THAT([&] { ReadPieces(scan(kHugeWord)); },
              ThrowsMessage<Error>(HasSubstr("a scan of 4294967295 readings")));
  ReadPieces(scan(kOne));
}

TEST(RawlogStream, RefusesAMovementWithoutItsDistribution) {
  const std::string pdf = "mrpt::poses::CPosePDFGaussian";
  const auto movement = [](const std::string& method, const std::string& next) {
    return std::vector<std::string>{Header(kMovement), kMovement, kVersion, method,
                                    Header(next),      next};
  };
  ReadPieces(movement(kZero, kPose));
  ReadPieces(movement(kOne, pdf));
  EXPECT_THAT([&] { ReadPieces(movement(kOne, kPose)); },
              ThrowsMessage<Error>(HasSubstr("a movement without its distribution")));
  EXPECT_THAT([&] { ReadPieces(movement(kHugeWord, pdf)); },
              ThrowsMessage<Error>(HasSubstr("estimated in an unknown way")));
  EXPECT_THAT([&] { ReadPieces(movement(kOne, "nullptr")); },
              ThrowsMessage<Error>(HasSubstr("a movement without its distribution")));
}

TEST(RawlogStream, FollowsOldFilesToo) {
  const std::string name = "CActionRobotMovement2D";
  const std::string length(1, static_cast<char>(name.size()));
  const std::string zeros(3, '\0');
  const std::string pose_length(1, static_cast<char>(kPose.size()));
  // The version is a word here; the method comes after it.
  ReadPieces({length, zeros, name, kOne, kZero, pose_length, zeros, kPose});
  EXPECT_THAT(
      [&] {
        ReadPieces({length, zeros, name, kZero, kOne, pose_length, zeros, kPose});
      },
      ThrowsMessage<Error>(HasSubstr("a movement without its distribution")));
}

}  // namespace
}  // namespace loopgrid
