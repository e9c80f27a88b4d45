// Compares branch and bound with trying every candidate, in many random worlds.

#include "frontend/matching/correlative_matcher.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

namespace loopgrid {
namespace {

using MatchPoints = std::vector<Eigen::Vector2f>;

// One search: a table, the points to place, and where to look for them.
struct Problem {
  LikelihoodTable table;
  MatchPoints points;
  SE2 center;
  SearchWindow window;
  double angle_step = 0.01;
  SearchPrior prior{};

  CorrelativeSearch Search() const { return {table, points, center, window, angle_step, prior}; }
};

LikelihoodTable MatchTable(const MatchPoints& reference, const SearchWindow& window,
                           float resolution, float sigma, int levels) {
  Eigen::Vector2f lower = reference.front();
  Eigen::Vector2f upper = reference.front();
  for (const Eigen::Vector2f& p : reference) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const int margin = CorrelativeSearch::MarginFor(window, resolution, levels) +
                     static_cast<int>(std::ceil(3.0F * sigma / resolution));
  return {reference, lower, upper, margin, resolution, sigma, levels};
}

template <typename T, std::size_t n>
T OneOf(const T (&choices)[n], std::mt19937* random) {
  return choices[(*random)() % n];
}

float Uniform(float low, float high, std::mt19937* random) {
  return std::uniform_real_distribution<float>(low, high)(*random);
}

MatchPoints RandomWalls(std::mt19937* random) {
  MatchPoints points;
  const int walls = static_cast<int>((*random)() % 4) + 1;
  for (int w = 0; w < walls; ++w) {
    const Eigen::Vector2f from{Uniform(-2.0F, 2.0F, random), Uniform(-2.0F, 2.0F, random)};
    const Eigen::Vector2f to{Uniform(-2.0F, 2.0F, random), Uniform(-2.0F, 2.0F, random)};
    const int count = static_cast<int>((*random)() % 25) + 1;
    for (int i = 0; i < count; ++i) {
      points.emplace_back(from + (to - from) * (static_cast<float>(i) / static_cast<float>(count)));
    }
  }
  return points;
}

// Reference points, and some of them seen from near the window's centre, with wrong points among
// them.
Problem RandomProblem(unsigned seed) {
  std::mt19937 random(seed);
  const SearchWindow window{OneOf({0.0, 0.05, 0.12, 0.33, 0.7}, &random),
                            OneOf({0.0, 0.05, 0.12, 0.33, 0.7}, &random),
                            OneOf({0.0, 0.01, 0.07}, &random)};
  const float resolution = OneOf({0.05F, 0.1F}, &random);
  const int levels = static_cast<int>(random() % 6) + 1;
  const MatchPoints reference = RandomWalls(&random);
  Problem problem{.table = MatchTable(reference, window, resolution, 0.08F, levels),
                  .points = {},
                  .center = SE2{Uniform(-5, 5, &random), Uniform(-5, 5, &random), 1.0 * seed},
                  .window = window};
  problem.angle_step = OneOf({0.01, 0.02}, &random);
  if (random() % 2 == 0) problem.prior = {0.1, 0.03, OneOf({0.02, 0.3}, &random)};
  const SE2 T_robot_map =
      problem.center.Boxplus({Uniform(-0.2F, 0.2F, &random), 0.1, 0.02}).Inverse();
  for (const Eigen::Vector2f& p : reference) {
    if (random() % 4 == 0) continue;
    problem.points.emplace_back((T_robot_map * p.cast<double>()).cast<float>());
  }
  for (int strays = static_cast<int>(random() % 10); strays >= 0; --strays) {
    problem.points.push_back({Uniform(-9, 9, &random), Uniform(-9, 9, &random)});
  }
  return problem;
}

struct Excluded {
  SearchOffset peak;
  int cells = -1;
  int steps = -1;

  bool Has(const SearchOffset& o) const {
    return std::abs(o.x - peak.x) <= cells && std::abs(o.y - peak.y) <= cells &&
           std::abs(o.angle - peak.angle) <= steps;
  }
};

// Tries every candidate in the documented order. Returns the first of the best.
SearchResult TryAll(const CorrelativeSearch& search, double min_score,
                    const Excluded& excluded = {}) {
  SearchResult best;
  best.score = min_score;
  for (int a = -search.angle_steps(); a <= search.angle_steps(); ++a) {
    for (int y = -search.cells_y(); y <= search.cells_y(); ++y) {
      for (int x = -search.cells_x(); x <= search.cells_x(); ++x) {
        const SearchOffset offset{x, y, a};
        if (excluded.Has(offset)) continue;
        const double score = search.Score(offset);
        if (score > best.score) best = {true, offset, search.PoseAt(offset), score};
      }
    }
  }
  return best;
}

void ExpectSameMatch(const SearchResult& result, const SearchResult& expected) {
  ASSERT_EQ(result.found, expected.found);
  if (!expected.found) return;
  EXPECT_EQ(result.offset.x, expected.offset.x);
  EXPECT_EQ(result.offset.y, expected.offset.y);
  EXPECT_EQ(result.offset.angle, expected.offset.angle);
  EXPECT_EQ(result.score, expected.score);
  EXPECT_EQ(result.T_map_robot.coordinates(), expected.T_map_robot.coordinates());
}

TEST(CorrelativeSearch, FindsWhatTryingEveryCandidateFinds) {
  for (unsigned seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE(seed);
    const Problem problem = RandomProblem(seed);
    const CorrelativeSearch search = problem.Search();
    const SearchResult expected = TryAll(search, -1e9);
    ExpectSameMatch(search.Best(-10.0), expected.score > -10.0 ? expected : SearchResult{});
    const double half_unit = 0.5 / (255.0 * static_cast<double>(problem.points.size()));
    ExpectSameMatch(search.Best(expected.score - half_unit), expected);
    EXPECT_FALSE(search.Best(expected.score + half_unit).found);
    EXPECT_FALSE(search.Best(2.0).found);
  }
}

TEST(CorrelativeSearch, FindsTheBestAwayFromAPeakAsTryingEveryCandidateDoes) {
  for (unsigned seed = 600; seed < 900; ++seed) {
    SCOPED_TRACE(seed);
    const Problem problem = RandomProblem(seed);
    const CorrelativeSearch search = problem.Search();
    const SearchOffset peak = TryAll(search, -1e9).offset;
    for (const Excluded& excluded :
         {Excluded{peak, 0, 0}, {peak, 2, 1}, {peak, 5, 100}, {peak, 100, 0}, {peak, 100, 100}}) {
      const SearchResult expected = TryAll(search, -50.0, excluded);
      ExpectSameMatch(search.BestAwayFrom(peak, excluded.cells, excluded.steps, -50.0), expected);
      const double too_much = expected.found ? expected.score + 1e-4 : 0.0;
      EXPECT_FALSE(
          search.BestAwayFrom(peak, excluded.cells, excluded.steps, too_much + 1e-9).found);
    }
  }
}

TEST(CorrelativeSearch, GivesTheFirstByAngleThenYThenXOfEqualCandidates) {
  // Reference points in every cell: all candidates are perfect.
  MatchPoints everywhere;
  for (int x = -80; x <= 80; ++x) {
    for (int y = -80; y <= 80; ++y) {
      everywhere.emplace_back(0.025F * static_cast<float>(x), 0.025F * static_cast<float>(y));
    }
  }
  for (int levels = 1; levels <= 6; ++levels) {
    const SearchWindow window{0.3, 0.2, 0.05};
    const LikelihoodTable full = MatchTable(everywhere, window, 0.05F, 0.05F, levels);
    const MatchPoints points = {{0.5F, 0.5F}, {-0.7F, 0.1F}};
    const CorrelativeSearch search(full, points, SE2(), window, 0.02);
    const SearchResult first = search.Best(0.5);
    EXPECT_EQ(first.offset, (SearchOffset{-6, -4, -3})) << levels;
    EXPECT_EQ(first.score, 1.0);
    EXPECT_EQ(search.BestAwayFrom(first.offset, 0, 0, 0.5).offset, (SearchOffset{-5, -4, -3}));
    EXPECT_EQ(search.BestAwayFrom(first.offset, 20, 0, 0.5).offset, (SearchOffset{-6, -4, -2}));
    EXPECT_EQ(search.BestAwayFrom(first.offset, 2, 20, 0.5).offset, (SearchOffset{-3, -4, -3}));
    // Even a small prior decides between equal candidates.
    const CorrelativeSearch guided(full, points, SE2(), window, 0.02, {0.1, 0.1, 0.1});
    EXPECT_EQ(guided.Best(0.5).offset, SearchOffset{});
  }
}

TEST(CorrelativeSearch, OfTwoEqualPeaksTakesTheFirst) {
  const SearchWindow window{0.5, 0.5, 0.0};
  const MatchPoints pair = {{-0.375F, 0.025F}, {0.425F, 0.025F}};
  for (int levels = 1; levels <= 5; ++levels) {
    const LikelihoodTable table = MatchTable(pair, window, 0.05F, 0.02F, levels);
    const MatchPoints one = {{0.025F, 0.025F}};
    const CorrelativeSearch search(table, one, SE2(), window, 0.01);
    EXPECT_EQ(search.Best(0.1).offset, (SearchOffset{-8, 0, 0})) << levels;
    EXPECT_EQ(search.BestAwayFrom({-8, 0, 0}, 3, 0, 0.1).offset, (SearchOffset{8, 0, 0}));
  }
}

TEST(CorrelativeSearch, InAnEmptyTableEveryCandidateScoresZero) {
  const SearchWindow window{0.3, 0.3, 0.1};
  const int margin = CorrelativeSearch::MarginFor(window, 0.05F, 4);
  const LikelihoodTable table({}, {-1.0F, -1.0F}, {1.0F, 1.0F}, margin, 0.05F, 0.07F, 4);
  const MatchPoints points = {{0.5F, 0.5F}, {-0.7F, 0.1F}};
  const CorrelativeSearch search(table, points, SE2(), window, 0.05);
  EXPECT_FALSE(search.Best(0.0).found);
  EXPECT_EQ(search.Best(-0.1).offset, (SearchOffset{-6, -6, -2}));
  EXPECT_EQ(search.Best(-0.1).score, 0.0);
}

TEST(CorrelativeSearch, FindsNothingWithoutPoints) {
  const Problem problem = RandomProblem(7);
  const CorrelativeSearch search(problem.table, {}, problem.center, problem.window, 0.01);
  EXPECT_FALSE(search.Best(0.0).found);
  EXPECT_FALSE(search.Best(-1.0).found);
  EXPECT_FALSE(search.BestAwayFrom({}, 1, 1, -1.0).found);
}

TEST(CorrelativeSearch, CountsPointsOutsideTheTableAsMisses) {
  Problem problem = RandomProblem(11);
  problem.prior.weight = 0.0;
  const SearchResult alone = problem.Search().Best(0.0);
  ASSERT_TRUE(alone.found);
  const auto before = static_cast<double>(problem.points.size());
  for (float far : {40.0F, -90.0F, 9000.0F}) problem.points.emplace_back(far, -far);
  const SearchResult result = problem.Search().Best(0.0);
  EXPECT_EQ(result.offset, alone.offset);
  EXPECT_NEAR(result.score, alone.score * before / (before + 3.0), 1e-12);
}

TEST(CorrelativeSearch, ScoreIsTheTablesMeanUnderThePointsLessThePriorsShare) {
  for (unsigned seed = 900; seed < 960; ++seed) {
    SCOPED_TRACE(seed);
    Problem problem = RandomProblem(seed);
    problem.center = SE2(problem.center.x(), problem.center.y(), 0.0);
    const CorrelativeSearch search = problem.Search();
    const SearchOffset offset{search.cells_x(), -search.cells_y(), 0};
    int sum = 0;
    for (const Eigen::Vector2f& p : problem.points) {
      const Eigen::Vector2f at = p + problem.center.translation().cast<float>();
      sum += problem.table.At(problem.table.CellOf(at) + Eigen::Vector2i(offset.x, offset.y));
    }
    const double cell = static_cast<double>(problem.table.resolution());
    const double x_sigmas = offset.x * cell / problem.prior.sigma_translation;
    const double y_sigmas = offset.y * cell / problem.prior.sigma_translation;
    const double full = 255.0 * static_cast<double>(problem.points.size());
    const double penalty = 0.5 * problem.prior.weight * (x_sigmas * x_sigmas + y_sigmas * y_sigmas);
    EXPECT_NEAR(search.Score(offset), sum / full - penalty, 2.0 / full);
  }
}

TEST(CorrelativeSearch, CoversTheWindowInWholeCellsAndSteps) {
  const SearchWindow window{0.3, 0.12, 0.05};
  const LikelihoodTable table = MatchTable({{0.0F, 0.0F}}, window, 0.05F, 0.07F, 3);
  const MatchPoints points = {{0.0F, 0.0F}};
  const CorrelativeSearch search(table, points, SE2(1.0, 2.0, 3.0), window, 0.02);
  EXPECT_EQ(search.cells_x(), 6);
  EXPECT_EQ(search.cells_y(), 3);
  EXPECT_EQ(search.angle_steps(), 3);
  const SE2 pose = search.PoseAt({-6, 3, 3});
  EXPECT_NEAR(pose.x(), 0.7, 1e-6);
  EXPECT_NEAR(pose.y(), 2.15, 1e-6);
  EXPECT_NEAR(pose.theta(), 3.06, 1e-12);
}

}  // namespace
}  // namespace loopgrid
