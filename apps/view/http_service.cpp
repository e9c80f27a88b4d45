#include "apps/view/http_service.h"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/stopwatch.h"

namespace loopgrid {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr auto kAcceptPause = std::chrono::milliseconds(100);
// After this time without events, viewers get an empty comment. Sending it finds viewers that are
// gone.
constexpr auto kSilence = std::chrono::seconds(15);

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

class HttpService::Impl : public HttpHub {
 public:
  explicit Impl(const ViewServerOptions& options)
      : options_(options), acceptor_(Bind(&io_, options_)), endpoint_(acceptor_.local_endpoint()) {}

  ~Impl() override {
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  void Start(HttpContent* content) {
    content_ = content;
    Accept();
    ScheduleBatch();
    thread_ = std::thread([this] { io_.run(); });
  }

  const tcp::endpoint& endpoint() const { return endpoint_; }

  void WaitUntilSent(double seconds) {
    std::unique_lock lock(mutex_);
    // The present batch may lack the last events. The batch after it has all of them.
    const std::int64_t begun = batches_;
    sent_.wait_for(lock, ClockDuration(seconds),
                   [&] { return batches_ > begun + 1 && !has_backlog_; });
  }

  HttpCounters counters() const {
    const std::lock_guard lock(mutex_);
    return counters_;
  }

  const ViewServerOptions& options() const override { return options_; }
  HttpContent* content() override { return content_; }

  void AddViewer(HttpClientConnection* viewer) override {
    viewers_.push_back(viewer);
    Count([](HttpCounters* counters) { ++counters->viewers; });
  }

  void CountRequest() override {
    Count([](HttpCounters* counters) { ++counters->requests; });
  }

  void CountSkip() override {
    Count([](HttpCounters* counters) { ++counters->skips; });
  }

  void Remove(HttpClientConnection* connection) override {
    const auto removed = std::erase(viewers_, connection);
    Count([removed](HttpCounters* counters) {
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
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error) {  // the process probably has no descriptor left; some may be closed soon
        pause_.expires_after(kAcceptPause);
        pause_.async_wait([this](error_code) { Accept(); });
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
        return;  // the socket is closed here
      }
      ++counters_.connections;
    }
    ServeHttpClient(&io_, socket.release(), this);
  }

  void ScheduleBatch() {
    batch_timer_.expires_after(ClockDuration(options_.batch_interval));
    batch_timer_.async_wait([this](error_code) {
      SendBatch();
      ScheduleBatch();
    });
  }

  void SendBatch() {
    auto news = content_->TakeNews();
    if (news == nullptr && Clock::now() - last_news_ >= kSilence) {
      news = std::make_shared<const std::string>(":\n\n");
    }
    bool has_backlog = false;
    for (HttpClientConnection* viewer : viewers_) {
      if (news != nullptr) viewer->Offer(news);
      has_backlog = has_backlog || viewer->HasBacklog();
    }
    if (news != nullptr) last_news_ = Clock::now();
    const std::lock_guard lock(mutex_);
    ++batches_;
    has_backlog_ = has_backlog;
    sent_.notify_all();
  }

  const ViewServerOptions options_;
  HttpContent* content_ = nullptr;

  mutable std::mutex mutex_;  // guards the members up to counters_
  std::condition_variable sent_;
  std::int64_t batches_ = 0;
  bool has_backlog_ = false;
  HttpCounters counters_;

  // Only the service's thread uses these.
  std::vector<HttpClientConnection*> viewers_;
  Clock::time_point last_news_ = Clock::now();
  // Destroyed before the members above, which connections use at their end.
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  const tcp::endpoint endpoint_;
  asio::steady_timer batch_timer_{io_};
  asio::steady_timer pause_{io_};
  std::thread thread_;
};

HttpService::HttpService(const ViewServerOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
HttpService::~HttpService() = default;
void HttpService::Start(HttpContent* content) { impl_->Start(content); }
int HttpService::port() const { return impl_->endpoint().port(); }
bool HttpService::is_loopback() const { return impl_->endpoint().address().is_loopback(); }
std::string HttpService::url() const {
  return fmt::format("http://{}:{}/", HostInUrl(impl_->endpoint().address()), port());
}
void HttpService::WaitUntilSent(double seconds) { impl_->WaitUntilSent(seconds); }
HttpCounters HttpService::counters() const { return impl_->counters(); }

}  // namespace loopgrid
