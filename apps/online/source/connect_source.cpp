#include "apps/online/source/connect_source.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <utility>

#include "apps/online/source/back_off.h"
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

// The system would wait for minutes for a host that does not answer.
constexpr std::chrono::seconds kPatience{10};

}  // namespace

class ConnectSource::Client {
 public:
  explicit Client(const ConnectOptions& options)
      : options_(options), back_off_(options.first_pause, options.longest_pause) {}

  void Run(LineQueue* queue);
  void Stop() { io_.stop(); }
  std::string name() const { return ToString(options_.address); }
  SourceCounters counters() const { return counters_.Snapshot(); }
  std::vector<std::string> TakeNotices() { return counters_.TakeNotices(); }

 private:
  void Resolve();
  void Dial(const tcp::resolver::results_type& endpoints);
  void Begin();
  void WaitForBytes();
  void Read();
  void TakeBytes(std::string_view bytes);
  void EndOfSender();
  bool FinishLines();
  void Fail(const std::string& problem);
  void TryAgainLater();

  ConnectOptions options_;
  asio::io_context io_{1};
  tcp::resolver resolver_{io_};
  tcp::socket socket_{io_};
  asio::steady_timer pause_{io_};     // before the next attempt
  asio::steady_timer patience_{io_};  // limit for the present attempt
  BackOff back_off_;

  LineInlet* inlet_ = nullptr;  // while running
  bool sent_something_ = false;
  SenderCheck check_;  // of this connection
  SocketReader reader_;
  SharedCounters counters_;
};

void ConnectSource::Client::Run(LineQueue* queue) {
  LineInlet inlet(queue);
  inlet_ = &inlet;
  Resolve();
  io_.run();
  FinishLines();
  error_code ignored;
  socket_.close(ignored);
}

void ConnectSource::Client::Resolve() {
  resolver_.async_resolve(
      options_.address.host, std::to_string(options_.address.port), tcp::resolver::numeric_service,
      [this](const error_code& error, const tcp::resolver::results_type& endpoints) {
        if (error) {
          Fail("cannot connect: " + error.message());
        } else {
          Dial(endpoints);
        }
      });
}

void ConnectSource::Client::Dial(const tcp::resolver::results_type& endpoints) {
  patience_.expires_after(kPatience);
  patience_.async_wait([this](const error_code& cancelled) {
    error_code ignored;
    if (!cancelled) socket_.close(ignored);
  });
  asio::async_connect(socket_, endpoints, [this](const error_code& error, const tcp::endpoint&) {
    // If there is no timer to cancel, it has expired and has closed the socket.
    const bool in_time = patience_.cancel() > 0;
    if (error || !in_time) {
      Fail("cannot connect: " + (in_time ? error.message() : "no answer"));
    } else {
      Begin();
    }
  });
}

void ConnectSource::Client::Begin() {
  KeepAlive(socket_.native_handle());
  sent_something_ = false;
  check_ = {};
  counters_.Count(&SourceCounters::connections);
  WaitForBytes();
}

void ConnectSource::Client::WaitForBytes() {
  socket_.async_wait(tcp::socket::wait_read, [this](const error_code&) { Read(); });
}

void ConnectSource::Client::Read() {
  const SocketReader::Outcome outcome = reader_.Read(socket_.native_handle());
  if (outcome == SocketReader::Outcome::kEnd) {
    EndOfSender();
  } else if (outcome == SocketReader::Outcome::kBytes) {
    TakeBytes(reader_.bytes());
  } else {
    WaitForBytes();
  }
}

void ConnectSource::Client::TakeBytes(std::string_view bytes) {
  const std::string_view passed = check_.Pass(bytes);
  if (!check_.problem().empty()) {
    Fail("left the sender: " + std::string(check_.problem()));
    return;
  }
  if (!passed.empty()) {
    if (!std::exchange(sent_something_, true)) counters_.Recover();
    back_off_.Reset();
    if (!inlet_->Add(passed)) io_.stop();
  }
  WaitForBytes();
}

/// Passes on the sender's last line, also without a line end. False if the queue is closed.
bool ConnectSource::Client::FinishLines() {
  sent_something_ = sent_something_ || check_.holds_bytes();
  return inlet_->Add(check_.Rest()) && inlet_->Finish();
}

void ConnectSource::Client::EndOfSender() {
  if (!FinishLines() || (options_.end_with_sender && sent_something_)) {
    io_.stop();
    return;
  }
  counters_.Note(reader_.problem().empty() ? "the sender closed the connection"
                                           : reader_.problem());
  TryAgainLater();
}

void ConnectSource::Client::Fail(const std::string& problem) {
  counters_.Count(&SourceCounters::failures);
  counters_.Note(problem);
  TryAgainLater();
}

void ConnectSource::Client::TryAgainLater() {
  error_code ignored;
  socket_.close(ignored);
  pause_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(back_off_.Next())));
  pause_.async_wait([this](const error_code&) { Resolve(); });
}

ConnectSource::ConnectSource(const ConnectOptions& options) {
  if (options.address.port == 0) {
    throw Error(ErrorCode::kUsage, ToString(options.address) + ": port 0 cannot be dialled");
  }
  client_ = std::make_unique<Client>(options);
}
ConnectSource::~ConnectSource() = default;

void ConnectSource::Run(LineQueue* queue) { client_->Run(queue); }
void ConnectSource::Stop() { client_->Stop(); }
std::string ConnectSource::name() const { return client_->name(); }
SourceCounters ConnectSource::counters() const { return client_->counters(); }
std::vector<std::string> ConnectSource::TakeNotices() { return client_->TakeNotices(); }

}  // namespace loopgrid
