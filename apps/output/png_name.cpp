#include "apps/output/png_name.h"

#include <filesystem>

#include "backend/base/error.h"

namespace loopgrid {

void RequirePngName(const std::string& option, const std::string& path) {
  const std::string kind = std::filesystem::path(path).extension().string();
  if (kind.empty() || kind == ".png" || kind == ".PNG") return;
  throw Error(ErrorCode::kUsage,
              option + " " + path + ": pictures are PNG, expected a name that ends in .png");
}

}  // namespace loopgrid
