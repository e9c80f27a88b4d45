#include "apps/settings/mapping_options.h"

#include <fmt/format.h>

#include <array>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr std::array<MappingOption, 4> kOptions = {{
    {.name = "--resolution",
     .key = "resolution",
     .unit = "METRES",
     .help = "Side of a map cell, {} to {} metres",
     .least = 0.01,
     .most = 1.0,
     .number = [](RunOptions& options) -> double& { return options.resolution; }},
    {.name = "--node-distance",
     .key = "node_distance",
     .unit = "METRES",
     .help = "A new node of the graph after this much travel, {} to {} metres",
     .least = SlamOptions::kLeastNodeDistance,
     .most = SlamOptions::kMostNodeDistance,
     .number = [](RunOptions& options) -> double& { return options.slam.node_distance; }},
    {.name = "--node-angle",
     .key = "node_angle",
     .unit = "RADIANS",
     .help = "... or after this much turning, {} to {} radians",
     .least = SlamOptions::kLeastNodeAngle,
     .most = SlamOptions::kMostNodeAngle,
     .number = [](RunOptions& options) -> double& { return options.slam.node_angle; }},
    {.name = "--strict",
     .key = "strict",
     .unit = "",
     .help = "Stop at the first malformed line of the log [default: skip and count them]",
     .flag = [](RunOptions& options) -> bool& { return options.strict; }},
}};

Argument ArgumentFor(const MappingOption& option, RunOptions* options) {
  Argument argument{.name = option.name, .unit = option.unit};
  if (option.number == nullptr) {
    argument.help = option.help;
    argument.target = &option.flag(*options);
  } else {
    argument.help = fmt::format(fmt::runtime(option.help), option.least, option.most);
    argument.target = &option.number(*options);
    argument.shows_default = true;
  }
  return argument;
}

}  // namespace

std::span<const MappingOption> MappingOptions() { return kOptions; }

std::vector<Argument> MappingArguments(RunOptions* options, std::set<std::string>* given) {
  std::vector<Argument> arguments;
  for (const MappingOption& option : kOptions) {
    arguments.push_back(ArgumentFor(option, options));
    if (given == nullptr) continue;
    arguments.back().given = [given, key = option.key] { given->insert(key); };
  }
  arguments.push_back({.name = "--quiet",
                       .help = "No progress bar [default: one if standard error is a terminal]",
                       .target = &options->quiet});
  return arguments;
}

void AddMappingFields(RunOptions options, JsonWriter* json) {
  for (const MappingOption& option : kOptions) {
    if (option.number == nullptr) {
      json->Field(option.key, option.flag(options));
    } else {
      json->Field(option.key, option.number(options));
    }
  }
}

void ValidateMapping(RunOptions options) {
  for (const MappingOption& option : kOptions) {
    if (option.number == nullptr) continue;
    const double value = option.number(options);
    // This form of the test also refuses NaN.
    if (value >= option.least && value <= option.most) continue;
    throw Error(ErrorCode::kUsage, fmt::format("{} is {}, expected {} to {}", option.name, value,
                                               option.least, option.most));
  }
}

}  // namespace loopgrid
