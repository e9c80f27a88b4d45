#include "apps/cli/nearest_name.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace loopgrid {
namespace {

/// Computed by the recursive definition.
std::size_t SlowDistance(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::string a1 = a.substr(1);
  const std::string b1 = b.substr(1);
  std::size_t least = std::min({SlowDistance(a1, b) + 1, SlowDistance(a, b1) + 1,
                                SlowDistance(a1, b1) + (a[0] == b[0] ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
    least = std::min(least, SlowDistance(a.substr(2), b.substr(2)) + 1);
  }
  return least;
}

TEST(EditDistance, IsThatOfTheDefinition) {
  std::mt19937 random(1);
  const auto word = [&random] {
    std::string text(random() % 6, 'a');
    for (char& c : text) c = static_cast<char>('a' + random() % 3);
    return text;
  };
  for (int i = 0; i < 300; ++i) {
    const std::string a = word();
    const std::string b = word();
    EXPECT_EQ(EditDistance(a, b), SlowDistance(a, b)) << a << ' ' << b;
  }
}

TEST(NearestName, FindsWhatWasMeant) {
  const std::vector<std::string> names = {
      "--resolution", "--resume", "--node-distance", "--node-angle",
      "--out",        "--strict", "--quiet",         "--parametrization"};
  EXPECT_EQ(NearestName("--resolutoin", names), "--resolution");
  EXPECT_EQ(NearestName("--resolutions", names), "--resolution");
  EXPECT_EQ(NearestName("--reslution", names), "--resolution");
  EXPECT_EQ(NearestName("--node_distance", names), "--node-distance");
  EXPECT_EQ(NearestName("--nodeangle", names), "--node-angle");
  EXPECT_EQ(NearestName("--parameterisation", names), "--parametrization");
  EXPECT_EQ(NearestName("-out", names), "--out");
  EXPECT_EQ(NearestName("--ot", names), "--out");
}

TEST(NearestName, TakesTheBeginningOfOneNameForIt) {
  const std::vector<std::string> names = {"--node-distance", "--node-angle", "--max-iterations"};
  EXPECT_EQ(NearestName("--max", names), "--max-iterations");
  EXPECT_EQ(NearestName("--node-d", names), "--node-distance");
  EXPECT_EQ(NearestName("--node", names), "") << "the beginning of two";
  EXPECT_EQ(NearestName("--ma", names), "") << "too short to tell";
}

TEST(NearestName, IsEmptyWhereNoneIsNear) {
  const std::vector<std::string> names = {"run", "eval", "--to", "--json"};
  for (const char* word : {"", "-", "--", "x", "--x", "map", "--speed", "--verbose"}) {
    EXPECT_EQ(NearestName(word, names), "") << word;
  }
  EXPECT_EQ(NearestName("run", {}), "");
}

}  // namespace
}  // namespace loopgrid
