#include "apps/output/same_file.h"

#include <filesystem>
#include <system_error>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;

/// The path with links followed, as far as it exists.
fs::path PlaceOf(const std::string& path) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(path, error);
  if (error) place = path;
  return fs::absolute(place, error).lexically_normal();
}

}  // namespace

bool IsSameFile(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (fs::is_other(a, error) || fs::is_other(b, error)) return false;
  return fs::equivalent(a, b, error) || PlaceOf(a) == PlaceOf(b);
}

void RequireOtherThanInput(const std::string& option, const std::string& output,
                           const std::string& input) {
  if (!IsSameFile(output, input)) return;
  throw Error(ErrorCode::kUsage,
              option + " " + output + ": is the input, which would be lost; take another name");
}

}  // namespace loopgrid
