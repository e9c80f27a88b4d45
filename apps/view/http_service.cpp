#include "apps/view/http_service.h"

#include <fmt/format.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxHeader = 8 * 1024;
constexpr std::size_t kMaxDiscarded = 64 * 1024;  // of what a refused client still sends
constexpr auto kLinger = std::chrono::seconds(2);
constexpr auto kAcceptPause = std::chrono::milliseconds(100);
constexpr auto kSilence = std::chrono::seconds(15);  // then a comment goes out: are you there?

beast::string_view ToBeast(std::string_view text) { return {text.data(), text.size()}; }
std::string_view ToStd(beast::string_view text) { return {text.data(), text.size()}; }

Clock::duration Seconds(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

class Connection;

// What connections need of their service.
class Hub {
 public:
  virtual ~Hub() = default;
  virtual const ViewServerOptions& options() const = 0;
  virtual HttpContent* content() = 0;
  virtual void AddViewer(Connection* viewer) = 0;
  virtual void CountRequest() = 0;
  virtual void CountSkip() = 0;
  virtual void Remove(Connection* connection) = 0;
};

// One client. It belongs to the operations that it waits for, and is gone when none is left.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Hub* hub) : stream_(std::move(socket)), hub_(hub) {}
  ~Connection() { hub_->Remove(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void ReadRequest() {
    parser_.emplace();
    parser_->header_limit(kMaxHeader);
    // One time-out for the whole header: sending it byte by byte wins nothing.
    stream_.expires_after(Seconds(hub_->options().request_timeout));
    http::async_read_header(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](error_code error, std::size_t) { self->HandleRequest(error); });
  }

  // News for a viewer. If too much is waiting for it already, it skips to a fresh state instead.
  void Offer(const std::shared_ptr<const std::string>& news) {
    if (needs_snapshot_) return;  // which will tell
    if (backlog_bytes_ + news->size() > hub_->options().max_backlog) {
      while (backlog_.size() > (is_writing_ ? 1u : 0u)) backlog_.pop_back();
      needs_snapshot_ = true;
      hub_->CountSkip();
    } else {
      backlog_.push_back(news);
      backlog_bytes_ += news->size();
    }
    WriteNews();
  }

  bool HasBacklog() const { return needs_snapshot_ || !backlog_.empty(); }

 private:
  void HandleRequest(error_code error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      return Refuse(431, "the header of the request is too long");
    }
    const bool is_gone =
        error == http::error::end_of_stream || error == http::error::partial_message;
    if (error.category() == http::make_error_code(http::error::bad_method).category() && !is_gone) {
      return Refuse(400, "this is not HTTP");
    }
    if (error) return;
    const auto& request = parser_->get();
    keeps_alive_ = request.keep_alive();
    wants_body_ = request.method() != http::verb::head;
    const bool has_body = !parser_->is_done();
    if (has_body) keeps_alive_ = false;  // it is not read
    hub_->CountRequest();
    Reply reply =
        hub_->content()->Answer({.method = ToStd(request.method_string()),
                                 .target = ToStd(request.target()),
                                 .host = ToStd(request[http::field::host]),
                                 .if_none_match = ToStd(request[http::field::if_none_match])});
    if (has_body && reply.status == 200) return Refuse(413, "requests have no body here");
    if (reply.follows_events) return FollowEvents(reply);
    Send(std::move(reply));
  }

  void Refuse(int status, std::string_view text) {
    keeps_alive_ = false;
    Send(ViewRoutes::Refusal(status, text));
  }

  template <typename Body>
  void SetHeader(const Reply& reply, http::response<Body>* response) const {
    response->result(static_cast<unsigned>(reply.status));
    response->set(http::field::server, "loopgrid");
    if (reply.status != 304) response->set(http::field::content_type, ToBeast(reply.type));
    for (const auto& [name, value] : reply.headers) {
      response->set(ToBeast(name), ToBeast(value));
    }
  }

  void Send(Reply reply) {
    const bool has_body = wants_body_ && reply.body != nullptr;
    // The response, and the body that it points to, live as long as it is being sent.
    auto response = std::make_shared<http::response<http::span_body<const char>>>();
    SetHeader(reply, response.get());
    response->keep_alive(keeps_alive_);
    if (reply.body != nullptr) response->content_length(reply.body->size());
    if (has_body) response->body() = {reply.body->data(), reply.body->size()};
    stream_.expires_after(Seconds(hub_->options().write_timeout));
    http::async_write(stream_, *response,
                      [self = shared_from_this(), response, body = std::move(reply.body)](
                          error_code error, std::size_t) { self->HandleSent(error); });
  }

  void HandleSent(error_code error) {
    if (error) return;
    if (keeps_alive_) return ReadRequest();
    // Closing now would make the system throw away what the client has not read yet, if it is still
    // sending itself.
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kLinger);
    Discard(0);
  }

  void Discard(std::size_t discarded) {
    if (discarded > kMaxDiscarded) return;
    stream_.async_read_some(asio::buffer(ignored_), [self = shared_from_this(), discarded](
                                                        error_code error, std::size_t n) {
      if (!error) self->Discard(discarded + n);
    });
  }

  // Server-sent events: a body without end.
  void FollowEvents(const Reply& reply) {
    auto response = std::make_shared<http::response<http::empty_body>>();
    SetHeader(reply, response.get());
    response->keep_alive(false);
    stream_.expires_after(Seconds(hub_->options().write_timeout));
    auto serializer = std::make_shared<http::response_serializer<http::empty_body>>(*response);
    http::async_write_header(
        stream_, *serializer,
        [self = shared_from_this(), response, serializer](error_code error, std::size_t) {
          if (error) return;
          if (!self->wants_body_) return self->HandleSent(error);
          self->WaitForGoodbye();
          self->hub_->AddViewer(self.get());
          self->needs_snapshot_ = true;
          self->WriteNews();
        });
  }

  // A viewer that closes the connection, or says anything more, is done.
  void WaitForGoodbye() {
    stream_.expires_never();
    stream_.async_read_some(asio::buffer(ignored_),
                            [self = shared_from_this()](error_code, std::size_t) {
                              error_code ignored;
                              self->stream_.socket().close(ignored);
                            });
  }

  void WriteNews() {
    if (is_writing_) return;
    if (needs_snapshot_) {
      backlog_ = {hub_->content()->Snapshot()};
      backlog_bytes_ = backlog_.front()->size();
      needs_snapshot_ = false;
    }
    if (backlog_.empty()) return;
    is_writing_ = true;
    stream_.expires_after(Seconds(hub_->options().write_timeout));
    asio::async_write(stream_, asio::buffer(*backlog_.front()),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (!error) self->HandleNewsWritten();
                      });
  }

  void HandleNewsWritten() {
    is_writing_ = false;
    backlog_bytes_ -= backlog_.front()->size();
    backlog_.pop_front();
    WriteNews();
  }

  beast::tcp_stream stream_;
  Hub* hub_;
  beast::flat_buffer buffer_{2 * kMaxHeader};
  std::optional<http::request_parser<http::empty_body>> parser_;
  bool keeps_alive_ = false;
  bool wants_body_ = true;
  std::array<char, 1024> ignored_;

  // Of a viewer.
  std::deque<std::shared_ptr<const std::string>> backlog_;  // the first one is being written
  std::size_t backlog_bytes_ = 0;
  bool is_writing_ = false;
  bool needs_snapshot_ = false;
};

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

class HttpService::Impl : public Hub {
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
    const std::int64_t begun = batches_;  // of a batch that may be under way only the next is whole
    sent_.wait_for(lock, Seconds(seconds), [&] { return batches_ > begun + 1 && !has_backlog_; });
  }

  HttpCounters counters() const {
    const std::lock_guard lock(mutex_);
    return counters_;
  }

  const ViewServerOptions& options() const override { return options_; }
  HttpContent* content() override { return content_; }

  void AddViewer(Connection* viewer) override {
    viewers_.push_back(viewer);
    Count([](HttpCounters* counters) { ++counters->viewers; });
  }

  void CountRequest() override {
    Count([](HttpCounters* counters) { ++counters->requests; });
  }

  void CountSkip() override {
    Count([](HttpCounters* counters) { ++counters->skips; });
  }

  void Remove(Connection* connection) override {
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
      if (error) {  // out of descriptors, most likely: some may be closed soon
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
        return;  // closes it
      }
      ++counters_.connections;
    }
    std::make_shared<Connection>(std::move(socket), this)->ReadRequest();
  }

  void ScheduleBatch() {
    batch_timer_.expires_after(Seconds(options_.batch_interval));
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
    for (Connection* viewer : viewers_) {
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

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable sent_;
  std::int64_t batches_ = 0;
  bool has_backlog_ = false;
  HttpCounters counters_;

  // Of the thread alone.
  std::vector<Connection*> viewers_;
  Clock::time_point last_news_ = Clock::now();
  asio::io_context io_{1};  // goes before the above, and takes all connections with it
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
