#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace loopgrid {

/// A value of an option as people write it.
template <typename Value>
struct Choice {
  std::string_view name;
  Value value;
};

template <typename Value>
Choice(const char*, Value) -> Choice<Value>;

template <typename Value, std::size_t kCount>
constexpr std::string_view NameOf(const std::array<Choice<Value>, kCount>& choices, Value value) {
  for (const Choice<Value>& choice : choices) {
    if (choice.value == value) return choice.name;
  }
  return "unknown";
}

}  // namespace loopgrid
