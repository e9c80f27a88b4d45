#include "apps/live/refresher.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include "backend/base/atomic_file.h"
#include "backend/files/graph_file.h"
#include "mapping/map_files.h"

namespace loopgrid {

Refresher::Refresher(std::string folder, double interval, LiveMap* map, PublishedFiles* published)
    : folder_(std::move(folder)),
      interval_(interval),
      map_(map),
      published_(published),
      thread_([this] { Serve(); }) {}

Refresher::~Refresher() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

bool Refresher::IsDue() const {
  const std::lock_guard lock(mutex_);
  if (problem_) std::rethrow_exception(problem_);
  return !content_ && Clock::now() >= next_;
}

void Refresher::Refresh(RefreshContent content) {
  {
    const std::lock_guard lock(mutex_);
    content_ = std::move(content);
  }
  wake_.notify_all();
}

std::optional<std::int64_t> Refresher::TakeSaved() {
  const std::lock_guard lock(mutex_);
  return std::exchange(saved_, std::nullopt);
}

std::optional<std::string> Refresher::TakeNote() {
  const std::lock_guard lock(mutex_);
  return std::exchange(note_, std::nullopt);
}

/// Notes a message, unless it is the same as the last one.
void Refresher::Note(std::string text) {
  if (text == last_note_) return;
  last_note_ = text;
  const std::lock_guard lock(mutex_);
  note_ = std::move(text);
}

void Refresher::Serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return closing_ || content_; });
    if (closing_) return;
    lock.unlock();
    const Clock::time_point start = Clock::now();
    std::exception_ptr problem;
    try {
      Write(*content_);
    } catch (...) {
      problem = std::current_exception();
    }
    const Clock::time_point end = Clock::now();
    lock.lock();
    problem_ = problem;
    if (!problem) saved_ = std::ssize(content_->trajectory);
    content_.reset();
    next_ = std::max(start + std::chrono::duration_cast<Clock::duration>(interval_),
                     end + 10 * (end - start));
  }
}

void Refresher::Write(const RefreshContent& content) {
  WriteOne("trajectory.tum", FormatTum(content.trajectory));
  WriteOne("graph.g2o", FormatGraph(content.graph));
  map_->WaitUntilCurrent();
  if (std::optional<MapFiles> map = DrawMap()) {
    WriteOne("map.png", std::move(map->png));
    WriteOne("map.pgm", std::move(map->pgm));
    WriteOne("map.yaml", std::move(map->yaml));
  }
}

std::optional<Refresher::MapFiles> Refresher::DrawMap() {
  try {
    const MapPicture map = map_->Picture();
    const double resolution = map.cells_per_pixel * map_->resolution();
    if (map.cells_per_pixel > 1) {
      Note(
          fmt::format("the map files have pixels of {:.6g} m: with pixels of {:.6g} m they would "
                      "be too large",
                      resolution, map_->resolution()));
    }
    return MapFiles{.png = EncodePng(map.image),
                    .pgm = EncodePgm(map.image),
                    .yaml = MapYaml(map.box, resolution, "map.pgm")};
  } catch (const std::bad_alloc&) {
    Note("the map files were not refreshed: too large for the memory");
  } catch (const std::exception& error) {
    Note(fmt::format("the map files were not refreshed: {}", error.what()));
  }
  return std::nullopt;
}

void Refresher::WriteOne(const std::string& name, std::string content) const {
  WriteFileAtomically(folder_ + "/" + name, content);
  if (published_ == nullptr) return;
  published_->Put(name, std::make_shared<const std::string>(std::move(content)));
}

}  // namespace loopgrid
