#include "apps/output/json_reader.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "backend/base/error.h"

namespace loopgrid {

JsonMembers::JsonMembers(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) ThrowDamaged();
  std::ifstream stream(path);
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) ThrowDamaged();
  for (const auto& [key, value] : json.items()) {
    if (value.is_boolean()) members_[key] = value.get<bool>();
    if (value.is_number()) members_[key] = value.get<double>();
    if (value.is_string()) members_[key] = value.get<std::string>();
  }
}

void JsonMembers::ThrowDamaged() const { throw Error(ErrorCode::kInput, path_ + ": is damaged"); }

}  // namespace loopgrid
