#include "backend/sparse/ordering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "backend/sparse/symbolic_factor.h"

namespace loopgrid {
namespace {

using Places = std::vector<BlockPlace>;
using Order = std::vector<int> (*)(int, std::span<const BlockPlace>);

std::vector<int> NaturalOrder(int n) {
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

Places Grid(int side) {
  Places places;
  for (int i = 0; i < side * side; ++i) {
    if (i % side + 1 < side) places.push_back({i, i + 1});
    if (i + side < side * side) places.push_back({i, i + side});
  }
  return places;
}

class OrderingTest : public ::testing::TestWithParam<Order> {
 protected:
  static void ExpectPermutation(int n, const Places& places) {
    std::vector<int> order = GetParam()(n, places);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, NaturalOrder(n)) << n << " columns, " << places.size() << " places";
  }
};

TEST_P(OrderingTest, IsAPermutationForAnyPattern) {
  std::mt19937 random(1);
  for (int n = 2; n <= 60; ++n) {
    for (int count : {0, 1, n / 2, n, 4 * n}) {
      std::set<std::pair<int, int>> pairs;
      std::uniform_int_distribution<int> any(0, n - 1);
      for (int k = 0; k < count; ++k) {
        const int a = any(random);
        const int b = any(random);
        if (a != b) pairs.insert(std::minmax(a, b));
      }
      Places places;
      for (const auto& [row, col] : pairs) places.push_back({row, col});
      std::shuffle(places.begin(), places.end(), random);
      ExpectPermutation(n, places);
    }
  }
}

TEST_P(OrderingTest, HandlesTheSmallestAndTheScattered) {
  ExpectPermutation(0, {});
  ExpectPermutation(1, {});
  ExpectPermutation(5, {});
  ExpectPermutation(2, {{0, 1}});
  Places scattered;  // two grids and columns without places before, between and behind
  for (const BlockPlace& place : Grid(15)) {
    scattered.push_back({place.row + 3, place.col + 3});
    scattered.push_back({place.row + 400, place.col + 400});
  }
  ExpectPermutation(1000, scattered);
  Places star;
  for (int i = 1; i < 500; ++i) star.push_back({0, i});
  ExpectPermutation(500, star);
}

TEST_P(OrderingTest, FillsLessThanTheNaturalOrderOnAGrid) {
  const Places grid = Grid(40);
  const SymbolicFactor natural = AnalyzeFactor(NaturalOrder(1600), grid);
  const SymbolicFactor ordered = AnalyzeFactor(GetParam()(1600, grid), grid);
  EXPECT_LT(ordered.entries, 0.5 * static_cast<double>(natural.entries));
  EXPECT_LT(ordered.Operations(), 0.3 * natural.Operations());
}

INSTANTIATE_TEST_SUITE_P(Orders, OrderingTest,
                         ::testing::Values(&MinimumDegreeOrder, &NestedDissectionOrder),
                         [](const auto& test) {
                           return test.index == 0 ? "MinimumDegree" : "NestedDissection";
                         });

// METIS calls srand() and rand().
TEST(NestedDissectionOrder, LeavesTheRandomNumbersOfTheProgramAlone) {
  const auto numbers = [](bool is_ordering) {
    std::srand(11);
    std::vector<int> result;
    for (int k = 0; k < 10; ++k) {
      if (is_ordering && k == 5) NestedDissectionOrder(2500, Grid(50));
      result.push_back(std::rand());
    }
    return result;
  };
  EXPECT_EQ(numbers(true), numbers(false));
}

TEST(NestedDissectionOrder, BeatsMinimumDegreeOnALargeGrid) {
  const Places grid = Grid(150);
  const SymbolicFactor dissected = AnalyzeFactor(NestedDissectionOrder(22500, grid), grid);
  const SymbolicFactor greedy = AnalyzeFactor(MinimumDegreeOrder(22500, grid), grid);
  EXPECT_LT(dissected.Operations(), 0.9 * greedy.Operations());
}

TEST(MinimumDegreeOrder, FillsNothingOnATree) {
  Places tree;
  for (int i = 1; i < 1000; ++i) tree.push_back({(i - 1) / 3, i});
  EXPECT_EQ(AnalyzeFactor(MinimumDegreeOrder(1000, tree), tree).entries, tree.size());
}

}  // namespace
}  // namespace loopgrid
