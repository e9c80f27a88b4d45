#include "apps/replay/replay_output.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cerrno>
#include <system_error>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

std::string ReasonOf() { return std::generic_category().message(errno); }

Descriptor ConnectTo(const HostPort& address) {
  asio::io_context io;
  tcp::socket socket(io);
  boost::system::error_code error;
  const auto endpoints = tcp::resolver(io).resolve(address.host, std::to_string(address.port),
                                                   tcp::resolver::numeric_service, error);
  if (!error) asio::connect(socket, endpoints, error);
  // Without this option a line could wait until the line before is acknowledged.
  if (!error) socket.set_option(tcp::no_delay(true), error);
  Descriptor descriptor;
  if (!error) descriptor = Descriptor(socket.release(error));
  if (error) {
    throw Error(ErrorCode::kOutput, ToString(address) + ": cannot connect: " + error.message());
  }
  return descriptor;
}

}  // namespace

ReplayOutput::ReplayOutput() : name_("standard output"), descriptor_(STDOUT_FILENO) {}

ReplayOutput::ReplayOutput(const HostPort& address)
    : name_(ToString(address)), socket_(ConnectTo(address)), descriptor_(socket_.get()) {}

void ReplayOutput::Write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor_, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      Fail("cannot write: " + ReasonOf());
    }
  }
}

void ReplayOutput::Finish() const {
  if (!socket_) return;
  if (shutdown(descriptor_, SHUT_WR) != 0) Fail("cannot write: " + ReasonOf());
  std::array<char, 4096> ignored;
  ssize_t count = 0;
  while ((count = recv(descriptor_, ignored.data(), ignored.size(), 0)) != 0) {
    if (count < 0 && errno != EINTR) Fail("the receiver did not take all of it: " + ReasonOf());
  }
}

void ReplayOutput::Fail(const std::string& problem) const {
  throw Error(ErrorCode::kOutput, name_ + ": " + problem);
}

}  // namespace loopgrid
