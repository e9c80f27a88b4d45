#include "apps/view/view_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "apps/net/host_check.h"
#include "apps/view/view_routes.h"
#include "apps/view/view_state.h"

namespace loopgrid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kFinishTimeout = std::chrono::seconds(2);
constexpr auto kQuiet = std::chrono::milliseconds(300);
constexpr auto kMovedNodesInterval = std::chrono::milliseconds(250);

std::string RandomName() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

}  // namespace

class ViewServer::Impl : public HttpContent {
 public:
  Impl(const ViewServerOptions& options, const LiveMap* map, const PublishedFiles* files)
      : map_(map),
        state_(RandomName(), map->resolution()),
        service_((options.Validate(), options)) {
    routes_ = std::make_unique<ViewRoutes>(
        state_.run(), HostCheck(service_.is_loopback(), options.host), &map->tiles(), files);
    service_.Start(this);
  }

  const HttpService& service() const { return service_; }

  void Add(const OnlineUpdate& update) {
    const std::lock_guard lock(mutex_);
    inbox_.push_back(update);
    inbox_.back().points = nullptr;  // viewers get them as tiles of the map
  }

  void Finish() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    const Clock::time_point start = Clock::now();
    service_.WaitUntilSent(std::chrono::duration<double>(kFinishTimeout).count());
    WaitForLastRequests(start + kFinishTimeout);
  }

  Reply Answer(const Request& request) override { return routes_->Answer(request); }

  std::shared_ptr<const std::string> TakeNews() override {
    const bool ending = TakeInbox();
    const std::vector<TileVersion> tiles = map_->tiles().ChangedSince(tiles_told_);
    if (!tiles.empty()) tiles_told_ = tiles.back().version;
    const Clock::time_point now = Clock::now();
    const bool moved_nodes_due = ending || now - moved_nodes_told_ >= kMovedNodesInterval;
    if (moved_nodes_due) moved_nodes_told_ = now;
    std::string news = state_.TakeChanges(tiles, moved_nodes_due);
    if (news.empty()) return nullptr;
    snapshot_ = nullptr;
    return std::make_shared<const std::string>(std::move(news));
  }

  std::shared_ptr<const std::string> Snapshot() override {
    if (snapshot_ == nullptr) {
      snapshot_ =
          std::make_shared<const std::string>(state_.Snapshot(map_->tiles().ChangedSince(0)));
    }
    return snapshot_;
  }

 private:
  // After the event `end` a page fetches the last tiles and closes its connection. Other viewers
  // fetch nothing.
  void WaitForLastRequests(Clock::time_point deadline) const {
    std::int64_t requests = -1;
    Clock::time_point quiet_since;
    while (true) {
      const HttpCounters counters = service_.counters();
      const Clock::time_point now = Clock::now();
      if (std::exchange(requests, counters.requests) != counters.requests) quiet_since = now;
      if (counters.viewers == 0 || now >= std::min(deadline, quiet_since + kQuiet)) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  // Applies the updates that have arrived. True after the last one.
  bool TakeInbox() {
    std::vector<OnlineUpdate> updates;
    bool ending = false;
    {
      const std::lock_guard lock(mutex_);
      updates.swap(inbox_);
      ending = ending_;
    }
    for (const OnlineUpdate& update : updates) state_.Apply(update);
    if (ending) state_.End();
    return ending;
  }

  const LiveMap* map_;

  std::mutex mutex_;  // guards the members up to ending_
  std::vector<OnlineUpdate> inbox_;
  bool ending_ = false;

  // Only the thread of the service uses the rest. It ends before they are destroyed.
  std::shared_ptr<const std::string> snapshot_;  // null if it is out of date
  std::uint64_t tiles_told_ = 0;
  Clock::time_point moved_nodes_told_;
  ViewState state_;
  std::unique_ptr<ViewRoutes> routes_;
  HttpService service_;
};

ViewServer::ViewServer(const ViewServerOptions& options, const LiveMap* map,
                       const PublishedFiles* files)
    : impl_(std::make_unique<Impl>(options, map, files)) {}
ViewServer::~ViewServer() = default;
int ViewServer::port() const { return impl_->service().port(); }
std::string ViewServer::url() const { return impl_->service().url(); }
bool ViewServer::is_loopback() const { return impl_->service().is_loopback(); }
void ViewServer::Add(const OnlineUpdate& update) { impl_->Add(update); }
void ViewServer::Finish() { impl_->Finish(); }
ViewServer::Counters ViewServer::counters() const { return impl_->service().counters(); }

}  // namespace loopgrid
