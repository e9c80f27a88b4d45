#include "apps/live/map_tiles.h"

#include <algorithm>
#include <span>
#include <utility>

namespace loopgrid {
namespace {

constexpr std::size_t kSide = kTileSide;

// 2^24 cells a pixel. This is enough for every grid.
constexpr int kCoarsestPicture = 24;

// Division that rounds down, also for negative numbers.
std::int64_t FloorDivide(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

CellBox BoxOf(const TileId& id) {
  const std::int64_t x = std::int64_t{id.x} * kTileSide;
  const std::int64_t y = std::int64_t{id.y} * kTileSide;
  return {x, y, x + kTileSide, y + kTileSide};
}

CellBox Intersection(const CellBox& a, const CellBox& b) {
  return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
          std::min(a.max_y, b.max_y)};
}

std::size_t IndexIn(const CellBox& box, std::int64_t x, std::int64_t y) {
  return static_cast<std::size_t>((y - box.min_y) * box.width() + x - box.min_x);
}

TileId ParentOf(const TileId& id) {
  return {id.level + 1, static_cast<int>(FloorDivide(id.x, 2)),
          static_cast<int>(FloorDivide(id.y, 2))};
}

// The squares of 2^level cells a side that `box` touches, as a box.
CellBox Shrunk(const CellBox& box, int level) {
  return {box.min_x >> level, box.min_y >> level, ((box.max_x - 1) >> level) + 1,
          ((box.max_y - 1) >> level) + 1};
}

std::uint8_t Combined(std::uint8_t a, std::uint8_t b) {
  if (a == kGreyUnknown) return b;
  return b == kGreyUnknown ? a : std::min(a, b);  // a wall is darker than free space
}

// Draws the pixels of `box`, each 2^-shift of a pixel of the picture a side. Those that lie outside
// of the picture are unknown.
void DrawTile(std::span<const std::uint8_t> pixels, const CellBox& box, int shift,
              MapPicture* picture) {
  auto pixel = pixels.begin();
  for (std::int64_t y = box.min_y; y < box.max_y; ++y) {
    const std::int64_t row = picture->box.max_y - 1 - (y >> shift);
    for (std::int64_t x = box.min_x; x < box.max_x; ++x, ++pixel) {
      if (*pixel == kGreyUnknown) continue;
      const std::int64_t column = (x >> shift) - picture->box.min_x;
      std::uint8_t& target =
          picture->image.pixels[static_cast<std::size_t>(row * picture->box.width() + column)];
      target = Combined(target, *pixel);
    }
  }
}

}  // namespace

void MapTiles::Update(const OccupancyGrid& grid, const CellBox& box) {
  if (box.empty()) return;
  std::vector<TileId> changed;
  for (std::int64_t y = FloorDivide(box.min_y, kTileSide); y * kTileSide < box.max_y; ++y) {
    for (std::int64_t x = FloorDivide(box.min_x, kTileSide); x * kTileSide < box.max_x; ++x) {
      const TileId id{0, static_cast<int>(x), static_cast<int>(y)};
      const CellBox part = Intersection(BoxOf(id), box);
      if (TakeCells(id, part, DrawCells(grid, part))) changed.push_back(id);
    }
  }
  UpdateCoarserLevels(std::move(changed));
}

MapTiles::Tile* MapTiles::FindOrAdd(const TileId& id) {
  Tile& tile = tiles_[id];
  if (tile.pixels == nullptr) {
    tile.pixels = std::make_unique<Pixels>();
    tile.pixels->fill(kGreyUnknown);
  }
  return &tile;
}

// `cells` are the pixels of `part`, which is within the tile. If all of them are unknown, no tile
// is made for them.
bool MapTiles::TakeCells(const TileId& id, const CellBox& part,
                         const std::vector<std::uint8_t>& cells) {
  const std::lock_guard lock(mutex_);
  const auto is_known = [](std::uint8_t grey) { return grey != kGreyUnknown; };
  if (!tiles_.contains(id) && std::none_of(cells.begin(), cells.end(), is_known)) return false;
  Tile* tile = FindOrAdd(id);
  bool changed = false;
  auto row = cells.begin();
  for (std::int64_t y = part.min_y; y < part.max_y; ++y, row += part.width()) {
    const auto target =
        tile->pixels->begin() + static_cast<std::ptrdiff_t>(IndexIn(BoxOf(id), part.min_x, y));
    if (std::equal(row, row + part.width(), target)) continue;
    std::copy(row, row + part.width(), target);
    changed = true;
  }
  if (changed) *tile = {std::move(tile->pixels), ++version_, nullptr};
  return changed;
}

// Draws `child` into its quarter of `parent`.
bool MapTiles::ShrinkInto(const TileId& parent, const TileId& child) {
  const std::lock_guard lock(mutex_);
  const Pixels& fine = *tiles_.at(child).pixels;
  Tile* tile = FindOrAdd(parent);
  const std::size_t left = child.x == 2 * parent.x ? 0 : kSide / 2;
  const std::size_t bottom = child.y == 2 * parent.y ? 0 : kSide / 2;
  bool changed = false;
  for (std::size_t y = 0; y < kSide; y += 2) {
    for (std::size_t x = 0; x < kSide; x += 2) {
      const std::size_t from = y * kSide + x;
      const std::uint8_t grey = Combined(Combined(fine[from], fine[from + 1]),
                                         Combined(fine[from + kSide], fine[from + kSide + 1]));
      std::uint8_t& pixel = (*tile->pixels)[(bottom + y / 2) * kSide + left + x / 2];
      changed = changed || pixel != grey;
      pixel = grey;
    }
  }
  if (changed) *tile = {std::move(tile->pixels), ++version_, nullptr};
  return changed;
}

void MapTiles::UpdateCoarserLevels(std::vector<TileId> changed) {
  for (int level = 1; level < kTileLevels; ++level) {
    std::vector<TileId> parents;
    for (const TileId& id : changed) {
      if (ShrinkInto(ParentOf(id), id)) parents.push_back(ParentOf(id));
    }
    std::sort(parents.begin(), parents.end());
    parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
    changed = std::move(parents);
  }
}

std::uint64_t MapTiles::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

std::vector<TileVersion> MapTiles::ChangedSince(std::uint64_t version) const {
  std::vector<TileVersion> changed;
  {
    const std::lock_guard lock(mutex_);
    if (version >= version_) return changed;
    for (const auto& [id, tile] : tiles_) {
      if (tile.version > version) changed.push_back({id, tile.version});
    }
  }
  std::sort(changed.begin(), changed.end(),
            [](const TileVersion& a, const TileVersion& b) { return a.version < b.version; });
  return changed;
}

std::shared_ptr<const std::string> MapTiles::Png(const TileId& id, std::uint64_t* version) const {
  GreyImage image{.width = kTileSide, .height = kTileSide, .pixels = {}};
  std::uint64_t drawn = 0;
  {
    const std::lock_guard lock(mutex_);
    const auto found = tiles_.find(id);
    if (found == tiles_.end()) return nullptr;
    drawn = found->second.version;
    if (version != nullptr) *version = drawn;
    if (found->second.png != nullptr) return found->second.png;
    for (std::size_t y = kSide; y-- > 0;) {
      const auto row = found->second.pixels->begin() + static_cast<std::ptrdiff_t>(y * kSide);
      image.pixels.insert(image.pixels.end(), row, row + kTileSide);
    }
  }
  auto png = std::make_shared<const std::string>(EncodePng(image));  // without the lock: it is slow
  const std::lock_guard lock(mutex_);
  Tile& tile = tiles_.at(id);
  if (tile.version == drawn) tile.png = png;
  return png;
}

// The caller holds the lock.
CellBox MapTiles::SeenBox() const {
  CellBox seen;
  for (const auto& [id, tile] : tiles_) {
    const CellBox box = BoxOf(id);
    if (id.level > 0 || seen.Contains(box)) continue;
    for (std::int64_t y = box.min_y; y < box.max_y; ++y) {
      for (std::int64_t x = box.min_x; x < box.max_x; ++x) {
        if ((*tile.pixels)[IndexIn(box, x, y)] == kGreyUnknown) continue;
        seen = seen.United({x, y, x + 1, y + 1});
      }
    }
  }
  return seen;
}

MapPicture MapTiles::Picture(std::int64_t max_side) const {
  const std::lock_guard lock(mutex_);
  const CellBox seen = SeenBox();
  int level = 0;
  const auto is_too_large = [max_side](const CellBox& box) {
    return std::max(box.width(), box.height()) > max_side;
  };
  while (level < kCoarsestPicture && is_too_large(Shrunk(seen, level))) ++level;
  MapPicture picture = BlankMap(Shrunk(seen, level));
  picture.cells_per_pixel = 1 << level;
  for (const auto& [id, tile] : tiles_) {
    if (id.level != std::min(level, kTileLevels - 1)) continue;
    DrawTile(*tile.pixels, BoxOf(id), level - id.level, &picture);
  }
  return picture;
}

}  // namespace loopgrid
