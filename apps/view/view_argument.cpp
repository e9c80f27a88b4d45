#include "apps/view/view_argument.h"

#include <memory>
#include <string>

#include "apps/view/view_address.h"
#include "apps/view/view_server.h"

namespace loopgrid {

LiveViewerOption DescribeView() {
  return {.name = "--view",
          .unit = "[HOST:]PORT",
          .help = "Serve a page that shows the map [default: none; to this machine only]",
          .check = [](const std::string& address) { ParseViewAddress(address); },
          .start = [](const std::string& address, const LiveMap* map,
                      const PublishedFiles* files) -> std::unique_ptr<LiveViewer> {
            return std::make_unique<ViewServer>(ParseViewAddress(address), map, files);
          }};
}

}  // namespace loopgrid
