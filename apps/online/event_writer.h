#pragma once

#include <cstdint>
#include <string>

#include "apps/live/online_update.h"
#include "apps/net/descriptor.h"
#include "apps/online/online_options.h"

namespace loopgrid {

/// Writes what happens as JSON, an object a line, for other programs to steer by (the README has
/// the schema). What is added goes out with Flush(). It waits for a reader that is slower than the
/// robot: the lines then queue up, and the sender has to wait. Errors are Error (kOutput).
class EventWriter {
 public:
  /// To nowhere.
  EventWriter() = default;

  /// `path` may be `-`: standard output. A file is added to.
  explicit EventWriter(const std::string& path);

  bool enabled() const { return static_cast<bool>(output_); }

  /// `page` is the address of the live page, empty if there is none.
  void Start(const OnlineOptions& options, const std::string& source, const std::string& page);
  void Resumed(std::int64_t lines, std::int64_t scans);
  void Known(std::int64_t lines);
  void Scan(const OnlineUpdate& update);
  void Warning(const std::string& text);
  void Saved(std::int64_t scans);
  void End(std::int64_t lines, std::int64_t scans, bool stopped);

  void Flush();

 private:
  std::string path_;
  Descriptor output_;
  std::string buffer_;
};

}  // namespace loopgrid
