#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "apps/cli/argument.h"
#include "apps/output/json_writer.h"
#include "apps/settings/run_options.h"

namespace loopgrid {

/// An option that changes the map. One table of them is used for the command line, its help, the
/// checks, report.json, session.json and the events. Exactly one of `number` and `flag` is set.
struct MappingOption {
  const char* name;  ///< on the command line
  const char* key;   ///< in files, as JSON
  const char* unit;  ///< name of its value in the help
  const char* help;  ///< for a number "{}" and "{}" stand for its bounds
  double least = 0.0;
  double most = 0.0;
  double& (*number)(RunOptions& options) = nullptr;
  bool& (*flag)(RunOptions& options) = nullptr;
};

/// All of them, in the order in which help and files name them.
std::span<const MappingOption> MappingOptions();

/// The arguments of a command that maps: all MappingOptions() and --quiet. Adds the key of each
/// mapping option that is on the command line to `given`, unless that is null.
std::vector<Argument> MappingArguments(RunOptions* options, std::set<std::string>* given);

/// Adds the value of every mapping option to the JSON object that is being written.
void AddMappingFields(RunOptions options, JsonWriter* json);

/// Throws Error (kUsage) naming option, value and bounds if one is out of its bounds.
void ValidateMapping(RunOptions options);

}  // namespace loopgrid
