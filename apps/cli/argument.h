#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace loopgrid {

/// An option that takes one of a few words.
struct WordChoice {
  std::vector<std::string> words = {};
  std::string preset = {};                         ///< the word for the default
  std::function<void(std::string_view)> set = {};  ///< called with one of `words`
};

/// The variable that an argument sets. Its type says which values are accepted: `bool` is a switch
/// without a value, a vector takes one value or more.
using ArgumentTarget =
    std::variant<bool*, std::string*, std::vector<std::string>*, int*, std::int64_t*, double*,
                 std::optional<std::int64_t>*, std::optional<double>*, WordChoice>;

/// An argument of a command. The value of an option must not be empty: a shell makes an empty value
/// of a variable that is not set.
struct Argument {
  std::string name = {};             ///< "--resolution"; a positional argument has no "--": "LOG"
  std::string unit = {};             ///< what the help calls the value: METRES, FILE
  std::string help = {};             ///< one sentence
  ArgumentTarget target = {};        ///< set by ParseCommandLine; outlives the argument
  bool required = false;             ///< whether it has to be given
  bool shows_default = false;        ///< whether the help shows the target's value as the default
  std::string field = {};            ///< its name in messages of the library; empty: see FieldOf
  std::function<void()> given = {};  ///< called if the argument is on the command line
};

/// The name of an argument in messages of the library: `field`, or else made of its name:
/// "--node-distance" -> "node_distance".
std::string FieldOf(const Argument& argument);

/// If `message` begins with the field of one of `arguments`, replaces it by the name of the
/// argument: "relative_decrease is -1, ..." -> "--tolerance is -1, ...".
std::string WithOptionNames(const std::string& message, const std::vector<Argument>& arguments);

}  // namespace loopgrid
