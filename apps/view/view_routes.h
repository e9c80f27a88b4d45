#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/live/map_tiles.h"
#include "apps/live/published_files.h"

namespace loopgrid {

/// What a request gets. Independent of any HTTP library.
struct Reply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  ///< null: none
  std::vector<std::pair<std::string, std::string>> headers;
  bool follows_events = false;  ///< the body is the stream of events, see ViewServer
};

/// What the server looks at in a request.
struct Request {
  std::string_view method;
  std::string_view target;
  std::string_view host;           ///< as in the header, with the port
  std::string_view if_none_match;  ///< empty if not given
};

/// Knows which address has which content.
class ViewRoutes {
 public:
  /// `run` tells one run of the program from another: the versions of tiles are its own. With
  /// `only_local_names` requests to another host than this machine are refused, which is how pages
  /// of other sites would have to come (DNS rebinding).
  ViewRoutes(std::string run, bool only_local_names, const MapTiles* tiles,
             const PublishedFiles* files);

  /// Headers that protect the page go with every reply.
  Reply Answer(const Request& request) const;

  /// A reply with a line of text.
  static Reply Refusal(int status, std::string_view text);

 private:
  Reply Dispatch(const Request& request) const;
  Reply File(std::string_view name, std::string_view type) const;
  Reply Tile(std::string_view path, std::string_view query, std::string_view if_none_match) const;

  std::string run_;
  bool only_local_names_;
  const MapTiles* tiles_;
  const PublishedFiles* files_;
};

}  // namespace loopgrid
