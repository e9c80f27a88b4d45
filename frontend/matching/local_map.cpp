#include "frontend/matching/local_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace loopgrid {
namespace {

// A hit and the square that it falls into.
struct Entry {
  std::uint64_t key = 0;  // square and direction of the normal
  Eigen::Vector2f position;
  Eigen::Vector2f normal;
};

// 0 without a normal, else 1..4: the quarter of the circle into which the normal points. This keeps
// the two faces of a thin wall apart.
std::uint64_t Facing(const Eigen::Vector2f& n) {
  if (n.isZero()) return 0;
  if (std::abs(n.x()) >= std::abs(n.y())) return n.x() > 0.0F ? 1 : 2;
  return n.y() > 0.0F ? 3 : 4;
}

std::uint64_t SquareKey(const Eigen::Vector2f& p, const Eigen::Vector2f& normal) {
  const auto part = [](float v) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / LocalMap::kSquare)) +
                                      (std::int64_t{1} << 28));
  };
  return (part(p.y()) << 34) | (part(p.x()) << 4) | Facing(normal);
}

std::vector<Entry> CollectHits(std::span<const PlacedScan> scans, const Eigen::Vector2d& center,
                               double radius) {
  std::vector<Entry> entries;
  std::size_t total = 0;
  for (const PlacedScan& placed : scans) total += placed.scan->size();
  entries.reserve(total);
  const float limit = static_cast<float>(radius * radius);
  const Eigen::Vector2f middle = center.cast<float>();
  for (const PlacedScan& placed : scans) {
    const Eigen::Matrix2f rotation = placed.T_map_robot.rotation().cast<float>();
    const Eigen::Vector2f translation = placed.T_map_robot.translation().cast<float>();
    for (std::size_t i = 0; i < placed.scan->size(); ++i) {
      const Eigen::Vector2f p = rotation * placed.scan->hits[i] + translation;
      if ((p - middle).squaredNorm() > limit) continue;
      const Eigen::Vector2f n = rotation * placed.scan->normals[i];
      entries.push_back({SquareKey(p, n), p, n});
    }
  }
  return entries;
}

}  // namespace

LocalMap::LocalMap(std::span<const PlacedScan> scans, const Eigen::Vector2d& center,
                   double radius) {
  std::vector<Entry> entries = CollectHits(scans, center, radius);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.key < b.key; });
  for (std::size_t i = 0; i < entries.size();) {
    Surfel surfel{Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), 0.0F};
    std::size_t k = i;
    for (; k < entries.size() && entries[k].key == entries[i].key; ++k) {
      surfel.position += entries[k].position;
      surfel.normal += entries[k].normal;
      surfel.weight += 1.0F;
    }
    surfel.position /= surfel.weight;
    const float length = surfel.normal.norm();
    if (length > 0.0F) surfel.normal /= length;
    surfels_.push_back(surfel);
    i = k;
  }
  FillBuckets();
}

void LocalMap::FillBuckets() {
  if (surfels_.empty()) return;
  lower_ = upper_ = surfels_.front().position;
  for (const Surfel& s : surfels_) {
    lower_ = lower_.cwiseMin(s.position);
    upper_ = upper_.cwiseMax(s.position);
  }
  columns_ = static_cast<int>((upper_.x() - lower_.x()) / kBucket) + 1;
  rows_ = static_cast<int>((upper_.y() - lower_.y()) / kBucket) + 1;
  const auto bucket = [&](const Surfel& s) {
    const int x = static_cast<int>((s.position.x() - lower_.x()) / kBucket);
    const int y = static_cast<int>((s.position.y() - lower_.y()) / kBucket);
    return static_cast<std::size_t>(y * columns_ + x);
  };
  bucket_begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Surfel& s : surfels_) ++bucket_begin_[bucket(s) + 1];
  for (std::size_t i = 1; i < bucket_begin_.size(); ++i) bucket_begin_[i] += bucket_begin_[i - 1];
  std::vector<int> next(bucket_begin_.begin(), bucket_begin_.end() - 1);
  std::vector<Surfel> sorted(surfels_.size());
  for (const Surfel& s : surfels_) sorted[static_cast<std::size_t>(next[bucket(s)]++)] = s;
  surfels_ = std::move(sorted);
}

const Surfel* LocalMap::NearestSurface(const Eigen::Vector2f& point,
                                       const Eigen::Vector2f& normal) const {
  const Surfel* best = nullptr;
  float best_distance = kBucket * kBucket;
  const int x = static_cast<int>(std::floor((point.x() - lower_.x()) / kBucket));
  const int y = static_cast<int>(std::floor((point.y() - lower_.y()) / kBucket));
  const int first_column = std::max(x - 1, 0);
  const int last_column = std::min(x + 1, columns_ - 1);
  if (first_column > last_column) return nullptr;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, rows_ - 1); ++row) {
    const int begin = bucket_begin_[static_cast<std::size_t>(row * columns_ + first_column)];
    const int end = bucket_begin_[static_cast<std::size_t>(row * columns_ + last_column) + 1];
    for (int i = begin; i < end; ++i) {
      const Surfel& s = surfels_[static_cast<std::size_t>(i)];
      const float distance = (s.position - point).squaredNorm();
      if (distance < best_distance && s.normal.dot(normal) > 0.7F) {
        best_distance = distance;
        best = &s;
      }
    }
  }
  return best;
}

}  // namespace loopgrid
