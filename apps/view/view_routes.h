#pragma once

#include <string>
#include <string_view>

#include "apps/live/map_tiles.h"
#include "apps/live/published_files.h"
#include "apps/net/host_check.h"
#include "apps/view/http_message.h"

namespace loopgrid {

/// Answers requests: finds the content for each address.
class ViewRoutes {
 public:
  /// `run` identifies this run of the program, because each run counts the versions of tiles from
  /// 0.
  ViewRoutes(std::string run, HostCheck hosts, const MapTiles* tiles, const PublishedFiles* files);

  /// Every reply has the headers that protect the page.
  Reply Answer(const Request& request) const;

 private:
  Reply Dispatch(const Request& request) const;
  Reply File(std::string_view name, std::string_view type) const;
  Reply Tile(std::string_view path, std::string_view query, std::string_view if_none_match) const;

  std::string run_;
  HostCheck hosts_;
  const MapTiles* tiles_;
  const PublishedFiles* files_;
};

}  // namespace loopgrid
