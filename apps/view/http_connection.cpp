#include "apps/view/http_connection.h"

#include "backend/base/stopwatch.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string_view>
#include <utility>

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

beast::string_view ToBeast(std::string_view text) { return {text.data(), text.size()}; }
std::string_view ToStd(beast::string_view text) { return {text.data(), text.size()}; }

// Limits the bytes that the system buffers for sending. The connection of a client that reads
// slowly then becomes writable again after every few kilobytes.
void LimitUnsentBytes(int socket) {
  constexpr int kUnsent = 64 * 1024;
  setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsent, sizeof kUnsent);
}

// The pending operations own the object. It is destroyed when there are none.
class Connection : public HttpClientConnection, public std::enable_shared_from_this<Connection> {
 public:
  Connection(asio::io_context* io, HttpHub* hub) : stream_(*io), hub_(hub) {}
  ~Connection() override { hub_->Remove(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void Start(int socket);
  void Offer(const std::shared_ptr<const std::string>& news) override;
  bool HasBacklog() const override { return needs_snapshot_ || !backlog_.empty(); }

 private:
  // A response being sent, and the body that it points to.
  struct Response {
    http::response<http::span_body<const char>> message;
    http::response_serializer<http::span_body<const char>> serializer{message};
    std::shared_ptr<const std::string> body;
  };

  void ReadRequest();
  void HandleRequest(error_code error);
  void Answer(const http::request<http::empty_body>& request, bool has_body);
  void Refuse(int status, std::string_view text);
  void Send(Reply reply);
  void SendPiece(std::shared_ptr<Response> response);
  void HandleSent();
  void Discard(std::size_t discarded);
  void FollowEvents(const Reply& reply);
  void WaitForGoodbye();
  void WriteNews();
  void WritePieceOfNews();

  template <typename Body>
  void SetHeader(const Reply& reply, http::response<Body>* response) const;

  beast::tcp_stream stream_;
  HttpHub* hub_;
  beast::flat_buffer buffer_{2 * kMaxHeader};
  std::optional<http::request_parser<http::empty_body>> parser_;
  bool keeps_alive_ = false;
  bool wants_body_ = true;
  std::array<char, 1024> ignored_;

  // Of a viewer.
  std::deque<std::shared_ptr<const std::string>> backlog_;  // the first one is being written
  std::size_t backlog_bytes_ = 0;
  std::size_t written_bytes_ = 0;  // of the first one
  bool is_writing_ = false;
  bool needs_snapshot_ = false;
};

void Connection::Start(int socket) {
  error_code error;
  stream_.socket().assign(tcp::v4(), socket, error);  // IPv4 or IPv6 makes no difference here
  if (error) {
    close(socket);
    return;
  }
  LimitUnsentBytes(socket);
  ReadRequest();
}

void Connection::ReadRequest() {
  parser_.emplace();
  parser_->header_limit(kMaxHeader);
  // One time limit for the whole header, also for a client that sends it byte by byte.
  stream_.expires_after(ClockDuration(hub_->options().request_timeout));
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](error_code error, std::size_t) { self->HandleRequest(error); });
}

void Connection::HandleRequest(error_code error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return Refuse(431, "the header of the request is too long");
  }
  const bool is_gone = error == http::error::end_of_stream || error == http::error::partial_message;
  if (error.category() == http::make_error_code(http::error::bad_method).category() && !is_gone) {
    return Refuse(400, "this is not HTTP");
  }
  if (error) return;
  Answer(parser_->get(), !parser_->is_done());
}

void Connection::Answer(const http::request<http::empty_body>& request, bool has_body) {
  keeps_alive_ = request.keep_alive() && !has_body;  // a body is not read
  wants_body_ = request.method() != http::verb::head;
  hub_->CountRequest();
  if (request.count(http::field::host) > 1) return Refuse(400, "there is more than one Host");
  Reply reply =
      hub_->content()->Answer({.method = ToStd(request.method_string()),
                               .target = ToStd(request.target()),
                               .host = ToStd(request[http::field::host]),
                               .if_none_match = ToStd(request[http::field::if_none_match])});
  if (has_body && reply.status == 200) return Refuse(413, "requests have no body here");
  if (reply.follows_events) return FollowEvents(reply);
  Send(std::move(reply));
}

void Connection::Refuse(int status, std::string_view text) {
  keeps_alive_ = false;
  Send(Refusal(status, text));
}

template <typename Body>
void Connection::SetHeader(const Reply& reply, http::response<Body>* response) const {
  response->result(static_cast<unsigned>(reply.status));
  response->set(http::field::server, "loopgrid");
  if (reply.status != 304) response->set(http::field::content_type, ToBeast(reply.type));
  for (const auto& [name, value] : reply.headers) response->set(ToBeast(name), ToBeast(value));
}

void Connection::Send(Reply reply) {
  const auto response = std::make_shared<Response>();
  response->body = std::move(reply.body);
  SetHeader(reply, &response->message);
  response->message.keep_alive(keeps_alive_);
  if (const auto& body = response->body) {
    response->message.content_length(body->size());
    if (wants_body_) response->message.body() = {body->data(), body->size()};
  }
  SendPiece(response);
}

// The time limit is for each piece, so a slow download may take long as long as it goes on.
void Connection::SendPiece(std::shared_ptr<Response> response) {
  stream_.expires_after(ClockDuration(hub_->options().write_timeout));
  auto& serializer = response->serializer;
  http::async_write_some(stream_, serializer,
                         [self = shared_from_this(), response = std::move(response)](
                             error_code error, std::size_t) mutable {
                           if (error) return;
                           if (response->serializer.is_done()) return self->HandleSent();
                           self->SendPiece(std::move(response));
                         });
}

void Connection::HandleSent() {
  if (keeps_alive_) return ReadRequest();
  // If the client is still sending, closing the connection now would discard what the client has
  // not read yet.
  error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  stream_.expires_after(kLinger);
  Discard(0);
}

void Connection::Discard(std::size_t discarded) {
  if (discarded > kMaxDiscarded) return;
  stream_.async_read_some(asio::buffer(ignored_),
                          [self = shared_from_this(), discarded](error_code error, std::size_t n) {
                            if (!error) self->Discard(discarded + n);
                          });
}

// Server-sent events: a body without end.
void Connection::FollowEvents(const Reply& reply) {
  auto response = std::make_shared<http::response<http::empty_body>>();
  SetHeader(reply, response.get());
  response->keep_alive(false);
  stream_.expires_after(ClockDuration(hub_->options().write_timeout));
  auto serializer = std::make_shared<http::response_serializer<http::empty_body>>(*response);
  http::async_write_header(
      stream_, *serializer,
      [self = shared_from_this(), response, serializer](error_code error, std::size_t) {
        if (error) return;
        if (!self->wants_body_) return self->HandleSent();
        self->WaitForGoodbye();
        self->hub_->AddViewer(self.get());
        self->needs_snapshot_ = true;
        self->WriteNews();
      });
}

// The connection of a viewer ends when the viewer closes it or sends anything more.
void Connection::WaitForGoodbye() {
  stream_.expires_never();
  stream_.async_read_some(asio::buffer(ignored_),
                          [self = shared_from_this()](error_code, std::size_t) {
                            error_code ignored;
                            self->stream_.socket().close(ignored);
                          });
}

void Connection::Offer(const std::shared_ptr<const std::string>& news) {
  if (needs_snapshot_) return;  // the snapshot will contain them
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

void Connection::WriteNews() {
  if (is_writing_) return;
  if (needs_snapshot_) {
    backlog_ = {hub_->content()->Snapshot()};
    backlog_bytes_ = backlog_.front()->size();
    needs_snapshot_ = false;
  }
  if (backlog_.empty()) return;
  is_writing_ = true;
  written_bytes_ = 0;
  WritePieceOfNews();
}

void Connection::WritePieceOfNews() {
  stream_.expires_after(ClockDuration(hub_->options().write_timeout));
  stream_.async_write_some(asio::buffer(*backlog_.front()) + written_bytes_,
                           [self = shared_from_this()](error_code error, std::size_t n) {
                             if (error) return;
                             const std::size_t size = self->backlog_.front()->size();
                             self->written_bytes_ += n;
                             if (self->written_bytes_ < size) return self->WritePieceOfNews();
                             self->is_writing_ = false;
                             self->backlog_bytes_ -= size;
                             self->backlog_.pop_front();
                             self->WriteNews();
                           });
}

}  // namespace

void ServeHttpClient(asio::io_context* io, int socket, HttpHub* hub) {
  std::make_shared<Connection>(io, hub)->Start(socket);
}

}  // namespace loopgrid
