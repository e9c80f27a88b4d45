#include "apps/online/online_options.h"

#include <fmt/format.h>

#include <string>

#include "apps/net/host_port.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

/// Checks an address with `parse`. The message of an error names the option.
void RequireAddress(const std::string& option, const std::string& address, const auto& parse) {
  if (address.empty()) return;
  try {
    parse(address);
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{}: {}", option, error.what()));
  }
}

}  // namespace

void OnlineOptions::Validate() const {
  const int sources =
      (follow.empty() ? 0 : 1) + (listen.empty() ? 0 : 1) + (connect.empty() ? 0 : 1);
  if (sources > 1) {
    throw Error(ErrorCode::kUsage, "--follow, --listen and --connect: more than one is given");
  }
  if (once && listen.empty() && connect.empty()) {
    throw Error(ErrorCode::kUsage, "--once is for --listen and --connect");
  }
  if (run.out.empty() && resume.empty()) {
    throw Error(ErrorCode::kUsage, "--out or --resume is missing: the folder of the session");
  }
  if (!run.out.empty() && !resume.empty()) {
    throw Error(ErrorCode::kUsage, "--out and --resume: the resumed session has its folder");
  }
  if (!continued.empty() && !resume.empty()) {
    throw Error(ErrorCode::kUsage, "--continue and --resume: a resumed session is not a new one");
  }
  // This form of the test also refuses NaN.
  if (!(interval >= kShortestInterval && interval <= kLongestInterval)) {
    throw Error(ErrorCode::kUsage, fmt::format("--interval is {}, expected {} to {}", interval,
                                               kShortestInterval, kLongestInterval));
  }
  if (threads < 1) {
    throw Error(ErrorCode::kUsage, fmt::format("--threads is {}, expected at least 1", threads));
  }
  RequireAddress("--listen", listen, ParseHostPort);
  RequireAddress("--connect", connect, ParseHostPort);
  RequireAddress(viewer.name, view, viewer.check);
  run.Validate();
}

}  // namespace loopgrid
