#include "backend/base/gzip.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>
#include <string>

namespace loopgrid {
namespace {

/// Unpacked by zlib, which has to find one gzip stream and nothing after it.
std::string Unpack(const std::string& packed, std::size_t size) {
  z_stream stream{};
  constexpr int kGzipOnly = 15 + 16;
  EXPECT_EQ(inflateInit2(&stream, kGzipOnly), Z_OK);
  std::string input = packed;
  std::string bytes(size + 1, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.avail_in, 0U);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

TEST(Gzip, UnpacksToTheSameBytes) {
  std::mt19937 random(1);
  for (const std::size_t size : {0U, 1U, 100U, 70'000U, 3'000'000U}) {
    std::string noise(size, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    EXPECT_EQ(Unpack(Gzip(noise), size), noise) << size;
    const std::string same(size, 'x');
    EXPECT_EQ(Unpack(Gzip(same), size), same) << size;
  }
}

TEST(Gzip, MakesTextSmaller) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "EDGE_SE2 " + std::to_string(i) + "\n";
  EXPECT_LT(Gzip(text).size(), text.size() / 3);
}

// Otherwise the same bytes would be packed into other ones a second later (RFC 1952, MTIME).
TEST(Gzip, PutsNoTimeIntoTheHeader) {
  EXPECT_EQ(Gzip("some text").substr(4, 4), std::string(4, '\0'));
}

}  // namespace
}  // namespace loopgrid
