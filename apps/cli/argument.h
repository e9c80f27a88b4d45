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
  std::string preset = {};                         ///< the word that stands for the default
  std::function<void(std::string_view)> set = {};  ///< called with one of `words`
};

/// Where the value of an argument goes. The type of the target says which values are accepted:
/// `bool` a switch without a value, a vector one value or more.
using ArgumentTarget =
    std::variant<bool*, std::string*, std::vector<std::string>*, int*, std::int64_t*, double*,
                 std::optional<std::int64_t>*, std::optional<double>*, WordChoice>;

/// One thing that a command takes from the command line. An option must not be given an empty text,
/// which is what a shell makes of a variable that is not set.
struct Argument {
  std::string name = {};       ///< "--resolution"; without "--" known by its place: "LOG"
  std::string unit = {};       ///< what the help calls the value: METRES, FILE
  std::string help = {};       ///< one sentence
  ArgumentTarget target = {};  ///< set by ParseCommandLine; outlives the argument
  bool required = false;       ///< whether the command cannot do without it
  bool shows_default = false;  ///< whether the help shows what the target holds beforehand
  std::string field = {};      ///< what messages of the library call it; empty: as FieldOf says
  std::function<void()> given = {};  ///< called if the argument is on the command line
};

/// What messages of the library call an argument: `field`, or the name without dashes as in
/// "--node-distance" -> "node_distance".
std::string FieldOf(const Argument& argument);

/// `message` with the argument as the user typed it, if it begins with the field of one of
/// `arguments`: "relative_decrease is -1, ..." -> "--tolerance is -1, ...".
std::string WithOptionNames(const std::string& message, const std::vector<Argument>& arguments);

}  // namespace loopgrid
