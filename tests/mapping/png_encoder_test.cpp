#include "mapping/png_encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Bytes = std::vector<std::uint8_t>;

Bytes RandomPixels(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  Bytes pixels(count);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random());
  return pixels;
}

// Decodes with OpenCV, not libpng. Its colours are blue, green, red.
cv::Mat DecodeUnchanged(const std::string& png) {
  return cv::imdecode(Bytes(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
}

TEST(PngEncoder, GreyPixelsComeBack) {
  for (const auto& [width, height] : {std::pair(1, 1), {7, 3}, {1, 50}, {300, 1}, {257, 129}}) {
    const Bytes pixels = RandomPixels(static_cast<std::size_t>(width * height), 3);
    const cv::Mat image = DecodeUnchanged(EncodePng(width, height, PixelFormat::kGrey, pixels));
    ASSERT_EQ(image.type(), CV_8UC1);
    ASSERT_EQ(image.size(), cv::Size(width, height));
    EXPECT_EQ(Bytes(image.begin<std::uint8_t>(), image.end<std::uint8_t>()), pixels);
  }
}

TEST(PngEncoder, ColoursComeBack) {
  for (const auto& [width, height] : {std::pair(1, 1), {7, 3}, {1, 50}, {300, 1}, {257, 129}}) {
    const Bytes pixels = RandomPixels(static_cast<std::size_t>(3 * width * height), 4);
    const cv::Mat image =
        DecodeUnchanged(EncodePng(width, height, PixelFormat::kRedGreenBlue, pixels));
    ASSERT_EQ(image.type(), CV_8UC3);
    ASSERT_EQ(image.size(), cv::Size(width, height));
    Bytes decoded;
    for (const cv::Vec3b& bgr : cv::Mat_<cv::Vec3b>(image)) {
      decoded.insert(decoded.end(), {bgr[2], bgr[1], bgr[0]});
    }
    EXPECT_EQ(decoded, pixels);
  }
}

TEST(PngEncoder, TheSamePixelsGiveTheBytesThatOpenCvGave) {
  Bytes pixels = RandomPixels(400 * 400, 5);
  std::fill(pixels.begin() + 9000, pixels.begin() + 90000, std::uint8_t{205});  // as in maps
  const cv::Mat image(400, 400, CV_8UC1, pixels.data());
  Bytes expected;
  cv::imencode(".png", image, expected, {cv::IMWRITE_PNG_COMPRESSION, 6});
  const std::string png = EncodePng(400, 400, PixelFormat::kGrey, pixels);
  EXPECT_TRUE(Bytes(png.begin(), png.end()) == expected);
}

TEST(PngEncoder, RefusesSizesThatCannotBe) {
  const Bytes pixels(12);
  for (const auto& [width, height] : {std::pair(0, 4), {4, 0}, {-3, -4}, {1000001, 1}}) {
    EXPECT_THROW(EncodePng(width, height, PixelFormat::kGrey, pixels), Error);
  }
  EXPECT_THAT([&] { EncodePng(4, 4, PixelFormat::kGrey, pixels); },
              ThrowsMessage<Error>(HasSubstr("4 x 4 pixels takes 16 bytes, not 12")));
  EXPECT_THAT([&] { EncodePng(4, 3, PixelFormat::kRedGreenBlue, pixels); },
              ThrowsMessage<Error>(HasSubstr("takes 36 bytes, not 12")));
}

}  // namespace
}  // namespace loopgrid
