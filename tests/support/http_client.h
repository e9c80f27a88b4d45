#pragma once

#include <map>
#include <memory>
#include <string>

namespace loopgrid::test_support {

struct HttpReply {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
};

struct HttpQuestion {
  std::string method = "GET";
  std::string target = "/";
  std::map<std::string, std::string> headers = {};
  std::string body = {};
};

/// A connection to an HTTP server that is kept for many requests. Throws std::runtime_error after a
/// minute without an answer.
class HttpClient {
 public:
  /// `address` is an IPv4 address.
  explicit HttpClient(int port, const std::string& address = "127.0.0.1");
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  HttpReply Ask(const HttpQuestion& question);
  HttpReply Get(const std::string& target) { return Ask({.target = target}); }

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
  int port_;
};

/// One request on a connection of its own.
HttpReply AskOnce(int port, const HttpQuestion& question);

}  // namespace loopgrid::test_support
