#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>

namespace loopgrid {

/// The members of a JSON object that are numbers, booleans or texts. Other members are left out.
class JsonMembers {
 public:
  /// Throws Error (kInput) `path: is damaged` if the file cannot be read or is not a JSON object.
  explicit JsonMembers(const std::string& path);

  // The member of this name. Throws Error (kInput) `path: is damaged` if there is none, or if it is
  // of another type.

  double Number(std::string_view key) const { return Get<double>(key); }
  bool Switch(std::string_view key) const { return Get<bool>(key); }
  std::string Text(std::string_view key) const { return Get<std::string>(key); }

 private:
  template <typename Value>
  const Value& Get(std::string_view key) const {
    const auto found = members_.find(key);
    const Value* value = found == members_.end() ? nullptr : std::get_if<Value>(&found->second);
    if (value == nullptr) ThrowDamaged();
    return *value;
  }
  [[noreturn]] void ThrowDamaged() const;

  std::string path_;
  std::map<std::string, std::variant<bool, double, std::string>, std::less<>> members_;
};

}  // namespace loopgrid
