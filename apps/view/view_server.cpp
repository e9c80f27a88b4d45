#include "apps/view/view_server.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <mutex>
#include <random>
#include <utility>
#include <vector>

#include "apps/net/host_port.h"
#include "apps/view/view_routes.h"
#include "apps/view/view_state.h"
#include "backend/base/error.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFinishTimeout = 2.0;  // seconds
constexpr auto kMovedNodesInterval = std::chrono::milliseconds(250);

template <typename Number>
void RequireBetween(const char* field, Number value, Number low, Number high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("{} is {}, expected {} to {}", field, value, low, high));
}

std::string RandomName() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

}  // namespace

void ViewServerOptions::Validate() const {
  if (host.empty()) throw Error(ErrorCode::kUsage, "host is empty, expected an address to bind to");
  RequireBetween("port", port, 0, 65535);
  RequireBetween("max_connections", max_connections, 1, 100'000);
  RequireBetween("request_timeout", request_timeout, 0.01, 3600.0);
  RequireBetween("write_timeout", write_timeout, 0.01, 3600.0);
  RequireBetween("batch_interval", batch_interval, 0.001, 10.0);
  RequireBetween("max_backlog", max_backlog, std::size_t{1}, std::size_t{1} << 30);
}

ViewServerOptions ParseViewAddress(std::string_view address) {
  ViewServerOptions options;
  if (ParseNumber(address, &options.port)) {
    RequireBetween("port", options.port, 0, 65535);
    return options;
  }
  HostPort host_port = ParseHostPort(address);
  options.host = std::move(host_port.host);
  options.port = host_port.port;
  return options;
}

class ViewServer::Impl : public HttpContent {
 public:
  Impl(const ViewServerOptions& options, const LiveMap* map, const PublishedFiles* files)
      : map_(map),
        state_(RandomName(), map->resolution()),
        service_((options.Validate(), options)) {
    routes_ =
        std::make_unique<ViewRoutes>(state_.run(), service_.is_loopback(), &map->tiles(), files);
    service_.Start(this);
  }

  const HttpService& service() const { return service_; }

  void Add(const OnlineUpdate& update) {
    const std::lock_guard lock(mutex_);
    inbox_.push_back(update);
    inbox_.back().points = nullptr;  // the map has them
  }

  void Finish() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    service_.WaitUntilSent(kFinishTimeout);
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
  // True if nothing more will come.
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

  std::mutex mutex_;  // of what follows
  std::vector<OnlineUpdate> inbox_;
  bool ending_ = false;

  // The rest belongs to the thread of the service, which is stopped first.
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
