#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace loopgrid {

/// The parts of a request that the server uses.
struct Request {
  std::string_view method;
  std::string_view target;
  std::string_view host;           ///< as in the header, with the port
  std::string_view if_none_match;  ///< empty if not given
};

/// The answer to a request. Does not depend on an HTTP library.
struct Reply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  ///< null: none
  std::vector<std::pair<std::string, std::string>> headers;
  bool follows_events = false;  ///< the body is the stream of events, see ViewServer
};

/// A reply with a line of text.
Reply Refusal(int status, std::string_view text);

}  // namespace loopgrid
