#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "apps/cli/argument.h"

namespace loopgrid {

/// A value of an option and the word for it.
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

/// The target of an option that takes one of `choices`, which must outlive it, and sets `field`.
template <typename Value, std::size_t kCount>
WordChoice OneOf(const std::array<Choice<Value>, kCount>& choices, Value preset, auto* field) {
  WordChoice result{.preset = std::string(NameOf(choices, preset))};
  for (const Choice<Value>& choice : choices) result.words.emplace_back(choice.name);
  result.set = [field, &choices](std::string_view word) {
    for (const Choice<Value>& choice : choices) {
      if (choice.name == word) *field = choice.value;
    }
  };
  return result;
}

}  // namespace loopgrid
