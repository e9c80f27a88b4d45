#include "apps/online/source/start_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/base/error.h"
#include "backend/base/gzip.h"

namespace loopgrid {
namespace {

using namespace std::string_literals;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

/// Looks at the bytes in pieces of a size.
void LookAt(const std::string& bytes, std::size_t size) {
  StartCheck check("stream");
  for (std::size_t i = 0; i < bytes.size(); i += size) check.Look(bytes.substr(i, size));
}

TEST(StartCheck, RefusesGzipAndBinaryDataInPiecesOfAnySize) {
  for (const std::size_t size :
       {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{9'999}}) {
    EXPECT_THAT([&] { LookAt(Gzip("FLASER"), size); },
                ThrowsMessage<Error>(StartsWith("stream: is gzipped: unpack it")));
    EXPECT_THAT([&] { LookAt("text and\0more"s, size); },
                ThrowsMessage<Error>(StartsWith("stream: is binary")));
    EXPECT_THAT([&] { LookAt(std::string(4'095, 'x') + "\0"s, size); },
                ThrowsMessage<Error>(StartsWith("stream: is binary")));
  }
}

TEST(StartCheck, LetsTextPassAndLooksNoFurtherThanTheStart) {
  for (const std::size_t size : {std::size_t{1}, std::size_t{4'000}, std::size_t{9'999}}) {
    EXPECT_NO_THROW(LookAt("\xEF\xBB\xBF# a log\nwith \x1F\x8B within\n", size));
    EXPECT_NO_THROW(LookAt("\x1Fx\x1F\x8B", size));
    EXPECT_NO_THROW(LookAt("\x8B\x1F\x8B", size));
    EXPECT_NO_THROW(LookAt(std::string(4'096, 'x') + "\0"s, size));
  }
}

}  // namespace
}  // namespace loopgrid
