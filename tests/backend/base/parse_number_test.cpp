#include "backend/base/parse_number.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/effort.h"

namespace loopgrid {
namespace {

TEST(ParseNumber, ReadsWholeNumbersAndDecimals) {
  double value = 0.0;
  EXPECT_TRUE(ParseNumber("1.5", &value));
  EXPECT_EQ(value, 1.5);
  EXPECT_TRUE(ParseNumber("-2.5e-3", &value));
  EXPECT_EQ(value, -2.5e-3);
  EXPECT_TRUE(ParseNumber("+7", &value));
  EXPECT_EQ(value, 7.0);
  EXPECT_TRUE(ParseNumber(".5", &value));
  EXPECT_EQ(value, 0.5);
  EXPECT_TRUE(ParseNumber("3.", &value));
  EXPECT_EQ(value, 3.0);
  int count = 0;
  EXPECT_TRUE(ParseNumber("-12", &count));
  EXPECT_EQ(count, -12);
}

TEST(ParseNumber, RefusesEverythingElseAndLeavesTheValueAlone) {
  for (const char* text : {"",     " ",        "+",     "-",      ".",   "+-1", "++1",  "1.5x",
                           "1 ",   " 1",       "1,5",   "0x10",   "nan", "NaN", "-nan", "inf",
                           "-inf", "infinity", "1e999", "-1e999", "e5",  "1e",  "--1",  "1.2.3"}) {
    SCOPED_TRACE(text);
    double value = 42.0;
    EXPECT_FALSE(ParseNumber(text, &value));
    EXPECT_EQ(value, 42.0);
    if (text[0] == ' ' || std::string_view(text) == "1 ") continue;  // blanks separate fields
    float single = 42.0F;
    EXPECT_FALSE(FieldCursor(text).NextDecimal(&single));
    EXPECT_EQ(single, 42.0F);
  }
  for (const char* text : {"1.5", "99999999999", "-99999999999", "1e3", ""}) {
    SCOPED_TRACE(text);
    int count = 42;
    EXPECT_FALSE(ParseNumber(text, &count));
    EXPECT_EQ(count, 42);
  }
}

TEST(FieldCursor, SplitsAtSpacesAndTabs) {
  FieldCursor fields("  FLASER\t 3  1.5\t\t");
  EXPECT_EQ(fields.Next(), "FLASER");
  int count = 0;
  EXPECT_TRUE(fields.Next(&count));
  EXPECT_EQ(count, 3);
  EXPECT_FALSE(fields.AtEnd());
  EXPECT_EQ(fields.offset(), 13U);
  float range = 0.0F;
  EXPECT_TRUE(fields.NextDecimal(&range));
  EXPECT_EQ(range, 1.5F);
  EXPECT_EQ(fields.offset(), 16U);
  EXPECT_TRUE(fields.AtEnd());
  EXPECT_EQ(fields.Next(), "");
  EXPECT_FALSE(fields.Next(&count));
  EXPECT_FALSE(fields.NextDecimal(&range));
}

template <typename Number, typename Bits>
void ExpectSameBitsOf(const std::string& text) {
  Number expected = 0;
  const bool is_number = ParseNumber(text, &expected);
  Number got = 0;
  ASSERT_EQ(FieldCursor(text).NextDecimal(&got), is_number) << text;
  ASSERT_EQ(std::bit_cast<Bits>(got), std::bit_cast<Bits>(expected)) << text;
}

// NextDecimal has a fast path; its results must be those of std::from_chars to the last bit.
void ExpectSameBits(const std::string& text) {
  ExpectSameBitsOf<float, std::uint32_t>(text);
  ExpectSameBitsOf<double, std::uint64_t>(text);
}

TEST(NextDecimal, AgreesWithFromCharsOnAllReadingsOfALaser) {
  char text[32];
  for (int i = 0; i < 1'000'000; i += test_support::Effort(1, 97)) {
    std::snprintf(text, sizeof(text), "%.2f", i / 100.0);
    ExpectSameBits(text);
    std::snprintf(text, sizeof(text), "%.3f", i / 1000.0);
    ExpectSameBits(text);
  }
}

TEST(NextDecimal, AgreesWithFromCharsBetweenNeighbouringFloats) {
  char text[64];
  for (int i = 1; i < 100'001;
       i += test_support::Effort(2, 194)) {  // 2^24 + odd: exactly between two floats
    std::snprintf(text, sizeof(text), "%d.000", 16'777'216 + i);
    ExpectSameBits(text);
  }
  std::mt19937 random(7);
  for (int i = 0; i < test_support::Effort(100'000, 1'000); ++i) {
    const float below = std::ldexp(static_cast<float>(random() % 16'777'216), -(i % 30));
    const float above = std::nextafter(below, std::numeric_limits<float>::max());
    const double middle = 0.5 * (static_cast<double>(below) + static_cast<double>(above));
    for (const int decimals : {4, 9, 14, 20, 40}) {
      std::snprintf(text, sizeof(text), "%.*f", decimals, middle);
      ExpectSameBits(text);
    }
  }
}

TEST(NextDecimal, AgreesWithFromCharsOnNumbersOfAGraph) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0.0, 100.0);
  char text[64];
  for (int i = 0; i < test_support::Effort(200'000, 2'000); ++i) {
    for (const char* format : {"%.6g", "%f", "%.15g", "%.17g", "%.0f"}) {
      std::snprintf(text, sizeof(text), format, normal(random));  // NOLINT: one of these
      ExpectSameBits(text);
    }
  }
  for (const char* edge : {"-0", "-0.0", "0", "-", "-.", ".", "-.5", "5.", "--1", "-+1", "+-1"}) {
    ExpectSameBits(edge);
  }
}

TEST(NextDecimal, AgreesWithFromCharsOnRandomText) {
  std::mt19937 random(8);
  const std::string alphabet = "00123456789999..-+e";
  for (int i = 0; i < test_support::Effort(1'000'000, 10'000); ++i) {
    std::string text;
    const std::size_t length = 1 + random() % 22;
    for (std::size_t k = 0; k < length; ++k) text += alphabet[random() % alphabet.size()];
    ExpectSameBits(text);
  }
}

TEST(Quoted, IsShortAndPrintableWhateverTheField) {
  EXPECT_EQ(Quoted("EDGE_SE4"), "'EDGE_SE4'");
  EXPECT_EQ(Quoted(""), "''");
  EXPECT_EQ(Quoted(std::string_view("a\0b\n", 4)), "'a?b?'");
  EXPECT_EQ(Quoted("\xff"), "'?'");
  EXPECT_EQ(Quoted(std::string(1000, 'x')).size(), 42u);
}

}  // namespace
}  // namespace loopgrid
