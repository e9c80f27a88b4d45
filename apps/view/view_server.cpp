#include "apps/view/view_server.h"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "apps/online/host_port.h"
#include "apps/view/view_connection.h"
#include "apps/view/view_routes.h"
#include "apps/view/view_state.h"
#include "backend/base/error.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr auto kFinishTimeout = std::chrono::seconds(2);
constexpr auto kAcceptPause = std::chrono::milliseconds(100);
constexpr auto kSilence = std::chrono::seconds(15);  // then a comment goes out: are you there?
constexpr auto kMovedNodesInterval = std::chrono::milliseconds(250);

Clock::duration Seconds(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

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

std::string HostInUrl(const asio::ip::address& address) {
  return address.is_v6() ? '[' + address.to_string() + ']' : address.to_string();
}

tcp::acceptor Bind(asio::io_context* io, const ViewServerOptions& options) {
  try {
    tcp::resolver resolver(*io);
    const auto found = resolver.resolve(options.host, std::to_string(options.port),
                                        tcp::resolver::passive | tcp::resolver::numeric_service);
    return tcp::acceptor(*io, found.begin()->endpoint());
  } catch (const boost::system::system_error& error) {
    throw Error(ErrorCode::kInput, fmt::format("{}:{}: cannot serve the page there: {}",
                                               options.host, options.port, error.code().message()));
  }
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

class ViewServer::Impl : public ViewConnection::Server {
 public:
  Impl(const ViewServerOptions& options, const LiveMap* map, const PublishedFiles* files)
      : options_((options.Validate(), options)),
        map_(map),
        acceptor_(Bind(&io_, options_)),
        endpoint_(acceptor_.local_endpoint()),
        state_(RandomName(), map->resolution()),
        routes_(state_.run(), is_loopback(), &map->tiles(), files) {
    Accept();
    ScheduleBatch();
    thread_ = std::thread([this] { io_.run(); });
  }

  ~Impl() override {
    io_.stop();
    thread_.join();
  }

  int port() const { return endpoint_.port(); }
  bool is_loopback() const { return endpoint_.address().is_loopback(); }
  std::string url() const {
    return fmt::format("http://{}:{}/", HostInUrl(endpoint_.address()), port());
  }

  void Add(const OnlineUpdate& update) {
    const std::lock_guard lock(mutex_);
    inbox_.push_back(update);
    inbox_.back().points = nullptr;  // the map has them
  }

  void Finish() {
    std::unique_lock lock(mutex_);
    ending_ = true;
    all_sent_.wait_for(lock, kFinishTimeout, [this] { return is_all_sent_; });
  }

  Counters counters() const {
    const std::lock_guard lock(mutex_);
    return counters_;
  }

  // What connections ask for, on the thread of the server.

  const ViewServerOptions& options() const override { return options_; }

  Reply Answer(const Request& request) override {
    Count([](Counters* counters) { ++counters->requests; });
    return routes_.Answer(request);
  }

  std::shared_ptr<const std::string> Snapshot() override {
    if (snapshot_ == nullptr) {
      snapshot_ =
          std::make_shared<const std::string>(state_.Snapshot(map_->tiles().ChangedSince(0)));
    }
    return snapshot_;
  }

  void AddViewer(ViewConnection* viewer) override {
    viewers_.push_back(viewer);
    Count([](Counters* counters) { ++counters->viewers; });
  }

  void CountSkip() override {
    Count([](Counters* counters) { ++counters->skips; });
  }

  void Remove(ViewConnection* connection) override {
    const auto removed = std::erase(viewers_, connection);
    Count([removed](Counters* counters) {
      --counters->connections;
      counters->viewers -= static_cast<int>(removed);
    });
  }

 private:
  template <typename Change>
  void Count(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(&counters_);
  }

  void Accept() {
    acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (error) {  // out of descriptors, most likely: some may be closed soon
        pause_.expires_after(kAcceptPause);
        pause_.async_wait([this](boost::system::error_code) { Accept(); });
        return;
      }
      Welcome(std::move(socket));
      Accept();
    });
  }

  void Welcome(tcp::socket socket) {
    {
      const std::lock_guard lock(mutex_);
      if (counters_.connections >= options_.max_connections) {
        ++counters_.turned_away;
        return;
      }
      ++counters_.connections;
    }
    StartConnection(std::move(socket), this);
  }

  void ScheduleBatch() {
    batch_timer_.expires_after(Seconds(options_.batch_interval));
    batch_timer_.async_wait([this](boost::system::error_code) {
      SendBatch();
      ScheduleBatch();
    });
  }

  void SendBatch() {
    const bool ending = TakeInbox();
    const Clock::time_point now = Clock::now();
    const std::vector<TileVersion> tiles = map_->tiles().ChangedSince(tiles_told_);
    if (!tiles.empty()) tiles_told_ = tiles.back().version;
    const bool moved_nodes_due = ending || now - moved_nodes_told_ >= kMovedNodesInterval;
    if (moved_nodes_due) moved_nodes_told_ = now;
    std::string news = state_.TakeChanges(tiles, moved_nodes_due);
    if (!news.empty()) snapshot_ = nullptr;
    if (news.empty() && now - last_news_ >= kSilence) news = ":\n\n";
    if (!news.empty()) {
      last_news_ = now;
      const auto shared = std::make_shared<const std::string>(std::move(news));
      for (ViewConnection* viewer : viewers_) viewer->Offer(shared);
    }
    if (ending) ReportAllSent();
  }

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

  void ReportAllSent() {
    for (const ViewConnection* viewer : viewers_) {
      if (viewer->HasBacklog()) return;
    }
    const std::lock_guard lock(mutex_);
    is_all_sent_ = true;
    all_sent_.notify_all();
  }

  const ViewServerOptions options_;
  const LiveMap* map_;

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable all_sent_;
  std::vector<OnlineUpdate> inbox_;
  bool ending_ = false;
  bool is_all_sent_ = false;
  Counters counters_;

  // Of the thread alone.
  std::vector<ViewConnection*> viewers_;
  std::shared_ptr<const std::string> snapshot_;  // null if it is out of date
  std::uint64_t tiles_told_ = 0;
  Clock::time_point moved_nodes_told_;
  Clock::time_point last_news_ = Clock::now();
  asio::io_context io_{1};  // goes first, and all connections with it: they use the rest
  tcp::acceptor acceptor_;
  const tcp::endpoint endpoint_;
  ViewState state_;
  const ViewRoutes routes_;
  asio::steady_timer batch_timer_{io_};
  asio::steady_timer pause_{io_};
  std::thread thread_;
};

ViewServer::ViewServer(const ViewServerOptions& options, const LiveMap* map,
                       const PublishedFiles* files)
    : impl_(std::make_unique<Impl>(options, map, files)) {}
ViewServer::~ViewServer() = default;
int ViewServer::port() const { return impl_->port(); }
std::string ViewServer::url() const { return impl_->url(); }
bool ViewServer::is_loopback() const { return impl_->is_loopback(); }
void ViewServer::Add(const OnlineUpdate& update) { impl_->Add(update); }
void ViewServer::Finish() { impl_->Finish(); }
ViewServer::Counters ViewServer::counters() const { return impl_->counters(); }

}  // namespace loopgrid
