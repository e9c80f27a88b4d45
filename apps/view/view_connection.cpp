#include "apps/view/view_connection.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <utility>

namespace loopgrid {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

constexpr std::size_t kMaxHeader = 8 * 1024;
constexpr std::size_t kMaxDiscarded = 64 * 1024;  // of what a refused client still sends
constexpr auto kLinger = std::chrono::seconds(2);

beast::string_view ToBeast(std::string_view text) { return {text.data(), text.size()}; }
std::string_view ToStd(beast::string_view text) { return {text.data(), text.size()}; }

std::chrono::nanoseconds Seconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(seconds));
}

class HttpConnection final : public ViewConnection,
                             public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(asio::ip::tcp::socket socket, Server* server)
      : stream_(std::move(socket)), server_(server) {}
  ~HttpConnection() override { server_->Remove(this); }

  void ReadRequest() {
    parser_.emplace();
    parser_->header_limit(kMaxHeader);
    // One time-out for the whole header: sending it byte by byte wins nothing.
    stream_.expires_after(Seconds(server_->options().request_timeout));
    http::async_read_header(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](error_code error, std::size_t) { self->HandleRequest(error); });
  }

  void Offer(const std::shared_ptr<const std::string>& news) override {
    if (needs_snapshot_) return;  // which will tell
    if (backlog_bytes_ + news->size() > server_->options().max_backlog) {
      while (backlog_.size() > (is_writing_ ? 1u : 0u)) backlog_.pop_back();
      needs_snapshot_ = true;
      server_->CountSkip();
    } else {
      backlog_.push_back(news);
      backlog_bytes_ += news->size();
    }
    WriteNews();
  }

  bool HasBacklog() const override { return needs_snapshot_ || !backlog_.empty(); }

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
    Reply reply = server_->Answer({.method = ToStd(request.method_string()),
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
    stream_.expires_after(Seconds(server_->options().write_timeout));
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
    stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
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
    stream_.expires_after(Seconds(server_->options().write_timeout));
    auto serializer = std::make_shared<http::response_serializer<http::empty_body>>(*response);
    http::async_write_header(
        stream_, *serializer,
        [self = shared_from_this(), response, serializer](error_code error, std::size_t) {
          if (error) return;
          if (!self->wants_body_) return self->HandleSent(error);
          self->WaitForGoodbye();
          self->server_->AddViewer(self.get());
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
      backlog_ = {server_->Snapshot()};
      backlog_bytes_ = backlog_.front()->size();
      needs_snapshot_ = false;
    }
    if (backlog_.empty()) return;
    is_writing_ = true;
    stream_.expires_after(Seconds(server_->options().write_timeout));
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
  Server* server_;
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

}  // namespace

void StartConnection(boost::asio::ip::tcp::socket socket, ViewConnection::Server* server) {
  std::make_shared<HttpConnection>(std::move(socket), server)->ReadRequest();
}

}  // namespace loopgrid
