#include "backend/sparse/symbolic_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "backend/sparse/ordering.h"

namespace loopgrid {
namespace {

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

std::vector<BlockPlace> RandomPattern(int n, int count, std::mt19937* random) {
  std::uniform_int_distribution<int> any(0, n - 1);
  std::set<std::pair<int, int>> places;
  for (int k = 0; k < count; ++k) {
    const int a = any(*random);
    const int b = any(*random);
    if (a != b) places.insert(std::minmax(a, b));
  }
  std::vector<BlockPlace> result;
  result.reserve(places.size());
  for (const auto& [row, col] : places) result.push_back({row, col});
  return result;
}

/// Which entries the factor has, by eliminating column after column.
std::vector<std::vector<bool>> BruteForceFactor(int n, const std::vector<BlockPlace>& places,
                                                const std::vector<int>& position) {
  std::vector<std::vector<bool>> L(Index(n), std::vector<bool>(Index(n), false));
  for (const BlockPlace& place : places) {
    const int a = position[Index(place.row)];
    const int b = position[Index(place.col)];
    L[Index(std::max(a, b))][Index(std::min(a, b))] = true;
  }
  for (int k = 0; k < n; ++k) {
    for (int i = k + 1; i < n; ++i) {
      for (int j = k + 1; j < i; ++j) {
        if (L[Index(i)][Index(k)] && L[Index(j)][Index(k)]) L[Index(i)][Index(j)] = true;
      }
    }
  }
  return L;
}

void ExpectConsistent(int n, const std::vector<BlockPlace>& places, const char* what) {
  SCOPED_TRACE(what);
  const SymbolicFactor factor = AnalyzeFactor(MinimumDegreeOrder(n, places), places);
  ASSERT_EQ(factor.order.size(), Index(n));
  for (int k = 0; k < n; ++k) ASSERT_EQ(factor.position[Index(factor.order[Index(k)])], k);
  ASSERT_EQ(factor.first_column.front(), 0);
  ASSERT_EQ(factor.first_column.back(), n);

  const auto L = BruteForceFactor(n, places, factor.position);
  for (int s = 0; s < factor.supernode_count(); ++s) {
    const std::set<int> rows(
        factor.rows.begin() + static_cast<std::ptrdiff_t>(factor.first_row[Index(s)]),
        factor.rows.begin() + static_cast<std::ptrdiff_t>(factor.first_row[Index(s) + 1]));
    ASSERT_EQ(static_cast<int>(rows.size()), factor.row_count(s));
    const int end = factor.first_column[Index(s) + 1];
    for (int row = end; row < n; ++row) {
      EXPECT_EQ(rows.count(row) == 1, L[Index(row)][Index(end - 1)]) << "its last column's rows";
      for (int col = factor.first_column[Index(s)]; col < end; ++col) {
        EXPECT_TRUE(rows.count(row) == 1 || !L[Index(row)][Index(col)]) << "no row is missing";
      }
    }
    const int parent = factor.parent[Index(s)];
    ASSERT_EQ(parent == -1, rows.empty());
    if (parent == -1) continue;
    ASSERT_GT(parent, s);
    std::size_t k = factor.first_row[Index(s)];
    for (int row : rows) {
      const int position = factor.row_in_parent[k++];
      ASSERT_EQ(position, factor.PositionInFront(parent, row));
      const int width = factor.columns(parent);
      const int found =
          position < width ? factor.first_column[Index(parent)] + position
                           : factor.rows[factor.first_row[Index(parent)] + Index(position - width)];
      ASSERT_EQ(found, row);
    }
  }
}

TEST(AnalyzeFactor, AgreesWithBruteForceElimination) {
  std::mt19937 random(21);
  for (int n = 1; n <= 40; ++n) {
    for (int count : {0, n / 2, n, 3 * n}) {
      ExpectConsistent(n, RandomPattern(n, count, &random), "seed 21");
    }
  }
}

TEST(AnalyzeFactor, HandlesChainsStarsAndFullMatrices) {
  constexpr int kCount = 30;
  std::vector<BlockPlace> chain;
  std::vector<BlockPlace> star;
  std::vector<BlockPlace> full;
  for (int i = 0; i < kCount; ++i) {
    if (i > 0) chain.push_back({i - 1, i});
    if (i < kCount - 1) star.push_back({i, kCount - 1});
    for (int j = 0; j < i; ++j) full.push_back({j, i});
  }
  ExpectConsistent(kCount, chain, "chain");
  ExpectConsistent(kCount, star, "star");
  ExpectConsistent(kCount, full, "full");
  EXPECT_EQ(AnalyzeFactor(MinimumDegreeOrder(kCount, full), full).supernode_count(), 1);
}

TEST(AnalyzeFactor, OfNothingIsNothing) {
  const SymbolicFactor factor = AnalyzeFactor({}, {});
  EXPECT_EQ(factor.supernode_count(), 0);
  EXPECT_TRUE(factor.order.empty());
}

TEST(AnalyzeFactor, FillsInNothingOnAChain) {
  std::vector<BlockPlace> chain;
  for (int i = 1; i < 1000; ++i) chain.push_back({i - 1, i});
  const SymbolicFactor factor = AnalyzeFactor(MinimumDegreeOrder(1000, chain), chain);
  for (int s = 0; s < factor.supernode_count(); ++s) EXPECT_LE(factor.row_count(s), 2);
}

}  // namespace
}  // namespace loopgrid
