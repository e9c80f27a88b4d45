#include "apps/view/view_address.h"

#include <utility>

#include "apps/net/host_port.h"
#include "backend/base/option_check.h"
#include "backend/base/parse_number.h"

namespace loopgrid {

ViewServerOptions ParseViewAddress(std::string_view address) {
  ViewServerOptions options;
  if (ParseNumber(address, &options.port)) {
    RequireViewPort(options.port);
    return options;
  }
  HostPort host_port = ParseHostPort(address);
  options.host = std::move(host_port.host);
  options.port = host_port.port;
  return options;
}

void RequireViewPort(int port) { RequireBetween("port", port, 0, 65535); }

}  // namespace loopgrid
