#include "apps/online/source/listen_source.h"

#include <poll.h>
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <chrono>
#include <optional>
#include <utility>

#include "apps/online/source/line_inlet.h"
#include "apps/online/source/sender_check.h"
#include "apps/online/source/shared_counters.h"
#include "apps/online/source/socket_reader.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

/// Listens at the first of the host's addresses that is free.
tcp::acceptor Listen(asio::io_context* io, const HostPort& address) {
  error_code error;
  const auto endpoints =
      tcp::resolver(*io).resolve(address.host, std::to_string(address.port),
                                 tcp::resolver::passive | tcp::resolver::numeric_service, error);
  for (const auto& entry : endpoints) {
    tcp::acceptor acceptor(*io);
    acceptor.open(entry.endpoint().protocol(), error);
    if (error) continue;
    acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!acceptor.bind(entry.endpoint(), error) && !acceptor.listen(SOMAXCONN, error)) {
      return acceptor;
    }
  }
  throw Error(ErrorCode::kInput, ToString(address) + ": cannot listen: " + error.message());
}

/// Whether the other end has closed its side. There may still be bytes to read.
bool IsLeaving(tcp::socket* socket) {
  pollfd state = {socket->native_handle(), POLLRDHUP, 0};
  return poll(&state, 1, 0) > 0;
}

/// Whether the other end has closed its side and all bytes are read.
bool HasLeft(tcp::socket* socket) {
  char byte = 0;
  const ssize_t count = recv(socket->native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
}

}  // namespace

class ListenSource::Server {
 public:
  explicit Server(const ListenOptions& options)
      : options_(options),
        acceptor_(Listen(&io_, options.address)),
        port_(acceptor_.local_endpoint().port()) {}

  void Run(LineQueue* queue);
  void Stop() { io_.stop(); }
  int port() const { return port_; }
  std::string name() const { return ToString({options_.address.host, port_}); }
  SourceCounters counters() const { return counters_.Snapshot(); }
  std::vector<std::string> TakeNotices() { return counters_.TakeNotices(); }

 private:
  void Accept();
  void Place(tcp::socket newcomer);
  bool IsSilent() const;
  void Begin(tcp::socket sender);
  void WaitForBytes();
  void Read();
  void TakeBytes(std::string_view bytes);
  void EndOfSender();
  bool FinishLines();
  void PassOn();

  ListenOptions options_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  int port_;
  asio::steady_timer pause_{io_};  // before the next attempt to accept

  LineInlet* inlet_ = nullptr;         // while running
  std::optional<tcp::socket> sender_;  // the sender that is read from
  std::optional<tcp::socket> next_;    // the sender after it
  int number_ = 0;                     // of the sender, from 1
  bool sent_something_ = false;
  SenderCheck check_;            // of the sender
  Clock::time_point last_line_;  // of the sender
  SocketReader reader_;
  SharedCounters counters_;
};

void ListenSource::Server::Run(LineQueue* queue) {
  LineInlet inlet(queue);
  inlet_ = &inlet;
  Accept();
  io_.run();
  FinishLines();
  acceptor_.close();
  sender_.reset();
  next_.reset();
}

void ListenSource::Server::Accept() {
  acceptor_.async_accept([this](const error_code& error, tcp::socket newcomer) {
    if (!error) {
      Place(std::move(newcomer));
      Accept();
      return;
    }
    counters_.Note("cannot accept: " + error.message());
    // The process may have no descriptors left. The pause keeps the attempts from using all
    // processor time.
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](const error_code&) { Accept(); });
  });
}

void ListenSource::Server::Place(tcp::socket newcomer) {
  if (sender_ && IsSilent()) Read();  // it may have sent something just now
  if (!sender_) {
    Begin(std::move(newcomer));
  } else if (IsLeaving(&*sender_) && (!next_ || HasLeft(&*next_))) {
    next_ = std::move(newcomer);
  } else if (IsSilent()) {
    next_ = std::move(newcomer);
    PassOn();
  } else {
    counters_.Count(&SourceCounters::refused);
    counters_.Note("turned a sender away: another one is sending");
  }
}

bool ListenSource::Server::IsSilent() const {
  return Clock::now() - last_line_ >= std::chrono::duration<double>(options_.silence);
}

void ListenSource::Server::Begin(tcp::socket sender) {
  KeepAlive(sender.native_handle());
  sender_ = std::move(sender);
  ++number_;
  sent_something_ = false;
  check_ = {};
  last_line_ = Clock::now();
  counters_.Count(&SourceCounters::connections);
  WaitForBytes();
}

void ListenSource::Server::WaitForBytes() {
  sender_->async_wait(tcp::socket::wait_read, [this, number = number_](const error_code&) {
    if (number != number_ || !sender_) return;  // that sender is gone
    Read();
    if (number == number_ && sender_) WaitForBytes();
  });
}

void ListenSource::Server::Read() {
  const SocketReader::Outcome outcome = reader_.Read(sender_->native_handle());
  if (outcome == SocketReader::Outcome::kEnd) {
    if (!reader_.problem().empty()) counters_.Note(reader_.problem());
    EndOfSender();
  } else if (outcome == SocketReader::Outcome::kBytes) {
    TakeBytes(reader_.bytes());
  }
}

void ListenSource::Server::TakeBytes(std::string_view bytes) {
  const std::string_view passed = check_.Pass(bytes);
  if (!check_.problem().empty()) {
    counters_.Count(&SourceCounters::refused);
    counters_.Note("turned a sender away: " + std::string(check_.problem()));
    PassOn();
    return;
  }
  if (passed.empty()) return;  // it is not known yet whether this is a log
  if (!std::exchange(sent_something_, true)) counters_.Recover();
  if (!inlet_->Add(passed)) io_.stop();
  if (inlet_->completed_line()) last_line_ = Clock::now();
}

void ListenSource::Server::EndOfSender() {
  if (options_.end_with_sender && (sent_something_ || check_.holds_bytes())) {
    io_.stop();
  } else {
    PassOn();
  }
}

/// Passes on the sender's last line, also without a line end. False if the queue is closed.
bool ListenSource::Server::FinishLines() { return inlet_->Add(check_.Rest()) && inlet_->Finish(); }

/// Changes to the next sender, if there is one.
void ListenSource::Server::PassOn() {
  sender_.reset();
  if (!FinishLines()) io_.stop();
  if (!next_) return;
  tcp::socket next = std::move(*next_);
  next_.reset();
  Begin(std::move(next));
}

ListenSource::ListenSource(const ListenOptions& options)
    : server_(std::make_unique<Server>(options)) {}
ListenSource::~ListenSource() = default;

void ListenSource::Run(LineQueue* queue) { server_->Run(queue); }
void ListenSource::Stop() { server_->Stop(); }
std::string ListenSource::name() const { return server_->name(); }
SourceCounters ListenSource::counters() const { return server_->counters(); }
std::vector<std::string> ListenSource::TakeNotices() { return server_->TakeNotices(); }
int ListenSource::port() const { return server_->port(); }

}  // namespace loopgrid
