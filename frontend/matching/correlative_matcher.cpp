#include "frontend/matching/correlative_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace loopgrid {
namespace {

int CellsIn(double metres, float resolution) {
  return static_cast<int>(std::ceil(metres / static_cast<double>(resolution) - 1e-6));
}

// The order of candidates with equal scores.
bool Precedes(const SearchOffset& a, const SearchOffset& b) {
  if (a.angle != b.angle) return a.angle < b.angle;
  if (a.y != b.y) return a.y < b.y;
  return a.x < b.x;
}

// The distance of the interval [low, low + length) from 0; it is 0 if the interval contains 0.
int NearestToZero(int low, int length) {
  if (low > 0) return low;
  return std::max(-(low + length - 1), 0);
}

}  // namespace

int CorrelativeSearch::MarginFor(const SearchWindow& window, float resolution, int levels) {
  return 2 * CellsIn(std::max(window.x, window.y), resolution) + (1 << levels) + 1;
}

CorrelativeSearch::CorrelativeSearch(const LikelihoodTable& table,
                                     std::span<const Eigen::Vector2f> points,
                                     const SE2& T_map_robot, const SearchWindow& window,
                                     double angle_step, const SearchPrior& prior)
    : table_(table),
      center_(T_map_robot),
      angle_step_(angle_step),
      cells_x_(CellsIn(window.x, table.resolution())),
      cells_y_(CellsIn(window.y, table.resolution())),
      angle_steps_(static_cast<int>(std::ceil(window.rotation / angle_step - 1e-6))),
      full_score_(static_cast<int>(points.size()) * 255) {
  const float translation_x = static_cast<float>(center_.x());
  const float translation_y = static_cast<float>(center_.y());
  for (int a = -angle_steps_; a <= angle_steps_; ++a) {
    const double angle = center_.theta() + a * angle_step_;
    const auto c = static_cast<float>(std::cos(angle));
    const auto s = static_cast<float>(std::sin(angle));
    std::vector<int>& indices = cells_.emplace_back();
    indices.reserve(points.size());
    for (const Eigen::Vector2f& p : points) {
      const Eigen::Vector2i cell = table_.CellOf(
          {c * p.x() - s * p.y() + translation_x, s * p.x() + c * p.y() + translation_y});
      // If the window of a point is not fully inside the table, the point can only reach the empty
      // margin.
      const bool inside = cell.x() >= cells_x_ && cell.x() + cells_x_ < table_.width() &&
                          cell.y() >= cells_y_ && cell.y() + cells_y_ < table_.height();
      if (inside) indices.push_back(cell.y() * table_.width() + cell.x());
    }
  }
  const double unit = prior.weight * full_score_ * 0.5;
  const auto penalty = [&](double sigmas) {
    return static_cast<int>(std::min(std::lround(unit * sigmas * sigmas), 1000000000L));
  };
  const double cell_sigmas = static_cast<double>(table.resolution()) / prior.sigma_translation;
  for (int i = 0; i <= std::max(cells_x_, cells_y_); ++i) {
    penalty_cells_.push_back(std::min(penalty(i * cell_sigmas), 500000000));
  }
  for (int i = 0; i <= angle_steps_; ++i) {
    penalty_angle_.push_back(penalty(i * angle_step_ / prior.sigma_rotation));
  }
}

SE2 CorrelativeSearch::PoseAt(const SearchOffset& offset) const {
  const double cell = static_cast<double>(table_.resolution());
  return SE2(center_.x() + offset.x * cell, center_.y() + offset.y * cell,
             center_.theta() + offset.angle * angle_step_);
}

int CorrelativeSearch::Penalty(const SearchOffset& corner, int level) const {
  const auto at = [](const std::vector<int>& table, int i) {
    return table[std::min(static_cast<std::size_t>(i), table.size() - 1)];
  };
  const int side = 1 << level;
  return std::min(at(penalty_cells_, NearestToZero(corner.x, side)) +
                      at(penalty_cells_, NearestToZero(corner.y, side)),
                  1000000000) +
         at(penalty_angle_, std::abs(corner.angle));
}

int CorrelativeSearch::Bound(const SearchOffset& corner, int level) const {
  const std::uint8_t* cells = table_.level(level) + corner.y * table_.width() + corner.x;
  int sum = 0;
  for (int index : cells_[static_cast<std::size_t>(corner.angle + angle_steps_)]) {
    sum += cells[index];
  }
  return sum - Penalty(corner, level);
}

double CorrelativeSearch::Score(const SearchOffset& offset) const {
  return static_cast<double>(Bound(offset, 0)) / full_score_;
}

bool CorrelativeSearch::CanBeat(const Block& block, const Incumbent& best) const {
  if (block.bound != best.score) return block.bound > best.score;
  return best.found && Precedes(block.corner, best.offset);
}

void CorrelativeSearch::Explore(const Block& block, const Exclusion& exclusion,
                                Incumbent* best) const {
  if (block.level == 0) {
    const bool excluded = std::abs(block.corner.x - exclusion.peak.x) <= exclusion.cells &&
                          std::abs(block.corner.y - exclusion.peak.y) <= exclusion.cells &&
                          std::abs(block.corner.angle - exclusion.peak.angle) <= exclusion.steps;
    if (!excluded) *best = {block.bound, block.corner, true};
    return;
  }
  std::array<Block, 4> children;
  int count = 0;
  const int half = 1 << (block.level - 1);
  for (int dy : {0, half}) {
    for (int dx : {0, half}) {
      const SearchOffset corner{block.corner.x + dx, block.corner.y + dy, block.corner.angle};
      if (corner.x > cells_x_ || corner.y > cells_y_) continue;
      children[static_cast<std::size_t>(count++)] = {corner, block.level - 1,
                                                     Bound(corner, block.level - 1)};
    }
  }
  std::stable_sort(children.begin(), children.begin() + count,
                   [](const Block& a, const Block& b) { return a.bound > b.bound; });
  for (int i = 0; i < count; ++i) {
    const Block& child = children[static_cast<std::size_t>(i)];
    if (CanBeat(child, *best)) Explore(child, exclusion, best);
  }
}

SearchResult CorrelativeSearch::Run(const Exclusion& exclusion, double min_score) const {
  Incumbent best;
  best.score = static_cast<int>(std::floor(min_score * full_score_));
  if (full_score_ == 0) return {};

  int top = table_.levels() - 1;
  while (top > 0 && (1 << (top - 1)) > std::max(cells_x_, cells_y_)) --top;
  const int side = 1 << top;
  std::vector<Block> blocks;
  for (int a = -angle_steps_; a <= angle_steps_; ++a) {
    for (int y = -cells_y_; y <= cells_y_; y += side) {
      for (int x = -cells_x_; x <= cells_x_; x += side) {
        const int bound = Bound({x, y, a}, top);
        if (bound > best.score) blocks.push_back({{x, y, a}, top, bound});
      }
    }
  }
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const Block& a, const Block& b) { return a.bound > b.bound; });
  for (const Block& block : blocks) {
    if (CanBeat(block, best)) Explore(block, exclusion, &best);
  }
  if (!best.found) return {};
  return {true, best.offset, PoseAt(best.offset), static_cast<double>(best.score) / full_score_};
}

SearchResult CorrelativeSearch::Best(double min_score) const { return Run({}, min_score); }

SearchResult CorrelativeSearch::BestAwayFrom(const SearchOffset& peak, int cells, int steps,
                                             double min_score) const {
  return Run({peak, cells, steps}, min_score);
}

}  // namespace loopgrid
