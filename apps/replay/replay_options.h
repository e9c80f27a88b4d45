#pragma once

#include <cstdint>
#include <string>

namespace loopgrid {

/// Options of `loopgrid replay`.
struct ReplayOptions {
  std::string log;             ///< a CARMEN log, may be gzipped
  double speed = 1.0;          ///< times real time; 0: as fast as the receiver takes it
  std::string to;              ///< HOST:PORT to connect to; empty: standard output
  std::int64_t loop = 1;       ///< how many times the log is played; 0: without end
  std::int64_t from_line = 1;  ///< the first line to play

  /// Throws Error (kUsage) naming the option, its value and its bounds.
  void Validate() const;
};

}  // namespace loopgrid
