#include "apps/live/live_map.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "apps/live/moving_map.h"
#include "backend/base/option_check.h"
#include "backend/base/stopwatch.h"

namespace loopgrid {
namespace {

using Clock = std::chrono::steady_clock;

// Number of updates taken, or scans drawn again, between two looks at the clock: a few milliseconds
// of work.
constexpr std::size_t kSlice = 32;

}  // namespace

void LiveMapOptions::Validate() const {
  grid.Validate();
  RequireBetween("publish_interval", publish_interval, 0.0, 60.0);
  RequireBetween("redraw_pause", redraw_pause, 1.0, 1000.0);
}

class LiveMap::Impl {
 private:
  // The parts of an update that are kept.
  struct Change {
    ScanOnMap scan;                           // if it has points
    std::shared_ptr<const NodeStates> nodes;  // may be null
  };

 public:
  explicit Impl(const LiveMapOptions& options)
      : options_((options.Validate(), options)), map_(options.grid) {
    thread_ = std::thread([this] { Run(); });
  }

  ~Impl() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    news_.notify_all();
    thread_.join();
  }

  void Add(const OnlineUpdate& update) {
    if (update.points == nullptr && update.nodes == nullptr) return;
    const TrackedScan& tracked = update.tracked;
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back(
          {{update.place, tracked.T_map_robot, tracked.localized, update.points}, update.nodes});
      ++added_;
    }
    news_.notify_all();
  }

  void WaitUntilCurrent() {
    std::unique_lock lock(mutex_);
    const std::int64_t last = added_;
    ++hurrying_;
    news_.notify_all();
    current_.wait(lock, [&] { return shown_ >= last; });
    --hurrying_;
  }

  const LiveMapOptions& options() const { return options_; }
  const MapTiles& tiles() const { return tiles_; }

  Counters counters() const {
    const std::lock_guard lock(mutex_);
    Counters counters = counters_;
    counters.waiting = queue_.size();
    return counters;
  }

 private:
  void Run() {
    while (true) {
      const bool hurry = WaitForWork();
      if (IsStopping()) return;
      const std::int64_t taken = TakeSlice();
      Redraw(hurry);
      Publish(hurry);
      Account(taken);
    }
  }

  // Waits until there is work. True if another thread waits for the picture.
  bool WaitForWork() {
    std::unique_lock lock(mutex_);
    const auto has_work = [this] {
      return stopping_ || !queue_.empty() || map_.IsRedrawing() || (hurrying_ > 0 && HasDuties());
    };
    if (HasDuties()) {
      const Clock::time_point due = has_unpublished_ ? next_publish_ : next_redraw_;
      news_.wait_until(lock, due, has_work);
    } else {
      news_.wait(lock, has_work);
    }
    return hurrying_ > 0;
  }

  // Whether the map has to be published or redrawn later.
  bool HasDuties() const { return has_unpublished_ || map_.IsOutdated(); }

  bool IsStopping() const {
    const std::lock_guard lock(mutex_);
    return stopping_;
  }

  // Takes some updates. Returns the number of all updates taken so far.
  std::int64_t TakeSlice() {
    std::deque<Change> slice;
    {
      const std::lock_guard lock(mutex_);
      for (std::size_t i = 0; i < kSlice && !queue_.empty(); ++i) {
        slice.push_back(std::move(queue_.front()));
        queue_.pop_front();
      }
    }
    for (const Change& change : slice) {
      if (change.nodes != nullptr) map_.MoveNodes(change.nodes->poses);
      if (change.scan.points != nullptr) map_.AddScan(change.scan);
    }
    taken_ += static_cast<std::int64_t>(slice.size());
    has_unpublished_ = has_unpublished_ || !slice.empty();
    return taken_;
  }

  void Redraw(bool hurry) {
    if (!map_.IsRedrawing()) {
      if (!map_.IsOutdated() || (!hurry && Clock::now() < next_redraw_)) return;
      redraw_start_ = Clock::now();
      map_.StartRedraw();
    }
    map_.ContinueRedraw(kSlice);
    if (map_.IsRedrawing()) return;
    next_redraw_ =
        redraw_start_ +
        ClockDuration(options_.redraw_pause *
                      std::chrono::duration<double>(Clock::now() - redraw_start_).count());
    has_unpublished_ = true;
    ++redraws_;
  }

  void Publish(bool hurry) {
    if (!has_unpublished_ || (!hurry && Clock::now() < next_publish_)) return;
    tiles_.Update(map_.grid(), map_.TakeChanges());
    next_publish_ = Clock::now() + ClockDuration(options_.publish_interval);
    has_unpublished_ = false;
  }

  void Account(std::int64_t taken) {
    const std::lock_guard lock(mutex_);
    counters_.scans = static_cast<std::int64_t>(map_.scans());
    counters_.left_out = map_.left_out();
    counters_.redraws = redraws_;
    if (HasDuties() || map_.IsRedrawing()) return;
    shown_ = taken;
    current_.notify_all();
  }

  const LiveMapOptions options_;
  MapTiles tiles_;

  mutable std::mutex mutex_;  // guards the members up to counters_
  std::condition_variable news_;
  std::condition_variable current_;
  std::deque<Change> queue_;
  std::int64_t added_ = 0;
  std::int64_t shown_ = 0;  // number of added updates that the picture shows
  int hurrying_ = 0;        // threads that wait for the picture
  bool stopping_ = false;
  Counters counters_;

  // Only the drawing thread uses these.
  MovingMap map_;
  std::int64_t taken_ = 0;
  std::int64_t redraws_ = 0;
  bool has_unpublished_ = false;
  Clock::time_point next_publish_;
  Clock::time_point next_redraw_;
  Clock::time_point redraw_start_;
  std::thread thread_;
};

LiveMap::LiveMap(const LiveMapOptions& options) : impl_(std::make_unique<Impl>(options)) {}
LiveMap::~LiveMap() = default;
void LiveMap::Add(const OnlineUpdate& update) { impl_->Add(update); }
void LiveMap::WaitUntilCurrent() { impl_->WaitUntilCurrent(); }
MapPicture LiveMap::Picture() const { return impl_->tiles().Picture(); }
double LiveMap::resolution() const { return impl_->options().grid.resolution; }
const MapTiles& LiveMap::tiles() const { return impl_->tiles(); }
LiveMap::Counters LiveMap::counters() const { return impl_->counters(); }

}  // namespace loopgrid
