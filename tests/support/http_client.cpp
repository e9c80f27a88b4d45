#include "tests/support/http_client.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <cctype>
#include <chrono>
#include <stdexcept>

namespace loopgrid::test_support {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

constexpr auto kPatience = std::chrono::seconds(60);

std::string LowerCase(beast::string_view text) {
  std::string lower;
  for (char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

struct HttpClient::Connection {
  asio::io_context io;
  beast::tcp_stream stream{io};
  beast::flat_buffer buffer;
  boost::system::error_code error;

  // Waits until the operation is done, for at most the time allowed.
  void Finish(const char* what) {
    io.restart();
    io.run();
    if (error) throw std::runtime_error(std::string(what) + ": " + error.message());
  }
  auto TakeError() {
    return [this](boost::system::error_code result, auto&&...) { error = result; };
  }
};

HttpClient::HttpClient(int port, const std::string& address)
    : connection_(std::make_unique<Connection>()), port_(port) {
  connection_->stream.expires_after(kPatience);
  connection_->stream.async_connect(asio::ip::tcp::endpoint(asio::ip::make_address_v4(address),
                                                            static_cast<unsigned short>(port)),
                                    connection_->TakeError());
  connection_->Finish("connecting");
}

HttpClient::~HttpClient() = default;

HttpReply HttpClient::Ask(const HttpQuestion& question) {
  http::request<http::string_body> request;
  request.method_string(question.method);
  request.target(question.target);
  request.set(http::field::host, "127.0.0.1:" + std::to_string(port_));
  for (const auto& [name, value] : question.headers) request.set(name, value);
  if (!question.body.empty()) {
    request.body() = question.body;
    request.prepare_payload();
  }
  connection_->stream.expires_after(kPatience);
  http::async_write(connection_->stream, request, connection_->TakeError());
  connection_->Finish("sending a request");

  http::response_parser<http::string_body> parser;
  parser.skip(question.method == "HEAD");
  parser.body_limit(std::size_t{256} << 20);
  connection_->stream.expires_after(kPatience);
  http::async_read(connection_->stream, connection_->buffer, parser, connection_->TakeError());
  connection_->Finish("reading a reply");
  HttpReply reply;
  reply.status = static_cast<int>(parser.get().result_int());
  for (const auto& field : parser.get()) {
    reply.headers[LowerCase(field.name_string())] = std::string(field.value());
  }
  reply.body = parser.get().body();
  return reply;
}

HttpReply AskOnce(int port, const HttpQuestion& question) { return HttpClient(port).Ask(question); }

}  // namespace loopgrid::test_support
