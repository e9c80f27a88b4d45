#include "apps/view/view_options.h"

#include <fmt/format.h>

#include <utility>

#include "apps/net/host_port.h"
#include "backend/base/error.h"
#include "backend/base/option_check.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
void ViewServerOptions::Validate() const {
  if (host.empty()) throw Error(ErrorCode::kUsage, "host is empty, expected an address to bind to");
  RequireBetween("port", port, 0, 65535);
  RequireBetween("max_connections", max_connections, 1, 100'000);
  RequireBetween("request_timeout", request_timeout, 0.01, 3600.0);
  RequireBetween("write_timeout", write_timeout, 0.01, 3600.0);
  RequireBetween("batch_interval", batch_interval, 0.001, 10.0);
  RequireBetween("max_backlog", static_cast<double>(max_backlog), 1.0, 1 << 30);
}

ViewServerOptions ParseViewAddress(std::string_view address) {
  ViewServerOptions options;
  if (ParseNumber(address, &options.port)) {
    RequireBetween("port", options.port, 0, 65535);
    return options;
  }
  HostPort host_port = ParseHostPort(address);
  options.host = std::move(host_port.host);
  options.port = host_port.port;
  return options;
}

}  // namespace loopgrid
