#include "apps/view/view_options.h"

#include "apps/view/view_address.h"
#include "backend/base/error.h"
#include "backend/base/option_check.h"

namespace loopgrid {

void ViewServerOptions::Validate() const {
  if (host.empty()) throw Error(ErrorCode::kUsage, "host is empty, expected an address to bind to");
  RequireViewPort(port);
  RequireBetween("max_connections", max_connections, 1, 100'000);
  RequireBetween("request_timeout", request_timeout, 0.01, 3600.0);
  RequireBetween("write_timeout", write_timeout, 0.01, 3600.0);
  RequireBetween("batch_interval", batch_interval, 0.001, 10.0);
  RequireBetween("max_backlog", static_cast<double>(max_backlog), 1.0, 1 << 30);
}

}  // namespace loopgrid
