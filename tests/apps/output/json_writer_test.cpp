#include "apps/output/json_writer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace loopgrid {
namespace {

using Json = nlohmann::ordered_json;
using Layout = JsonWriter::Layout;

std::string Dump(const Json& json, Layout layout) {
  const int indent = layout == Layout::kOneLine ? -1 : 2;
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

template <typename Value>
std::string TextOf(const Value& value) {
  return JsonWriter(Layout::kOneLine).Value(value).Take();
}

/// A random value, written by both writers.
class RandomJson {
 public:
  RandomJson(std::uint32_t seed, Layout layout) : random_(seed), writer_(layout) {
    expected_ = Make(3);
  }

  std::string text() { return writer_.Take(); }
  const Json& expected() const { return expected_; }

 private:
  Json Make(int depth) {
    switch (random_() % (depth > 0 ? 7 : 5)) {
      case 0:
        writer_.Null();
        return nullptr;
      case 1:
        writer_.Value(true);
        return true;
      case 2: {
        const auto value = static_cast<std::int64_t>(random_()) - (std::int64_t{1} << 31);
        writer_.Value(value);
        return value;
      }
      case 3: {
        const auto value = std::bit_cast<double>(random_() * 0x9e3779b97f4a7c15u);
        writer_.Value(value);
        return value;
      }
      case 4: {
        const std::string text = RandomText();
        writer_.Value(text);
        return text;
      }
      case 5:
        return MakeArray(depth);
      default:
        return MakeObject(depth);
    }
  }

  Json MakeArray(int depth) {
    Json array = Json::array();
    writer_.BeginArray();
    for (auto size = random_() % 4; size > 0; --size) array.push_back(Make(depth - 1));
    writer_.EndArray();
    return array;
  }

  Json MakeObject(int depth) {
    Json object = Json::object();
    writer_.BeginObject();
    for (auto size = random_() % 4; size > 0; --size) {
      const std::string key = std::to_string(size) + RandomText();
      writer_.Key(key);
      object[key] = Make(depth - 1);
    }
    writer_.EndObject();
    return object;
  }

  std::string RandomText() {
    std::string text;
    for (auto size = random_() % 6; size > 0; --size) {
      constexpr char kAwkward[] = "a\"\\\n\t\x01\x7f\xc3\xa9\xff\xe2/";
      text += kAwkward[random_() % (sizeof(kAwkward) - 1)];
    }
    return text;
  }

  std::mt19937_64 random_;
  JsonWriter writer_;
  Json expected_;
};

TEST(JsonWriter, WritesTheBytesThatNlohmannsLibraryWrites) {
  for (const Layout layout : {Layout::kOneLine, Layout::kIndented}) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
      RandomJson random(seed, layout);
      ASSERT_EQ(random.text(), Dump(random.expected(), layout)) << "seed " << seed;
    }
  }
}

TEST(JsonWriter, NumbersReadBackAreTheSame) {
  for (const double value : {0.1, 0.05, 1e-10, 1e300, 5e-324, -0.0, 1.0 / 3.0, 123456789.125}) {
    EXPECT_EQ(Json::parse(TextOf(value)).get<double>(), value);
  }
  EXPECT_EQ(TextOf(std::numeric_limits<std::int64_t>::min()), "-9223372036854775808");
  EXPECT_EQ(TextOf(std::size_t{7}), "7");
}

TEST(JsonWriter, NumbersWithAFormatHaveSoManyDigits) {
  EXPECT_EQ(TextOf(FixedNumber{2.0 / 3.0, 3}), "0.667");
  EXPECT_EQ(TextOf(FixedNumber{1e9, 0}), "1000000000");
  EXPECT_EQ(TextOf(RoundedNumber{2.0 / 3.0, 2}), "0.67");
  EXPECT_EQ(TextOf(RoundedNumber{1e-7, 4}), "1e-07");
}

TEST(JsonWriter, NumbersThatJsonDoesNotHaveAreNull) {
  for (const double value :
       {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(TextOf(value), "null");
    EXPECT_EQ(TextOf(FixedNumber{value, 2}), "null");
    EXPECT_EQ(TextOf(RoundedNumber{value, 2}), "null");
  }
}

TEST(JsonWriter, RangesAreArraysAndFieldsAreMembers) {
  JsonWriter json(Layout::kOneLine);
  json.BeginObject().Field("texts", std::vector<std::string>{"a", "b"});
  json.Field("none", std::vector<int>()).Field("yes", true).Field("word", "w");
  json.Key("raw").Raw("{}").EndObject();
  EXPECT_EQ(json.Take(), R"({"texts":["a","b"],"none":[],"yes":true,"word":"w","raw":{}})");
  EXPECT_EQ(json.Take(), "") << "nothing is left";
}

}  // namespace
}  // namespace loopgrid
