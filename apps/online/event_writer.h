#pragma once

#include <cstdint>
#include <string>

#include "apps/live/online_update.h"
#include "apps/net/descriptor.h"
#include "apps/online/online_options.h"

namespace loopgrid {

/// Writes events for other programs, one JSON object a line (see README.md). Flush() writes the
/// events added so far. It waits for a slow reader. Lines of the log then wait in the queue, and in
/// the end the sender waits. Throws Error (kOutput).
class EventWriter {
 public:
  /// Writes nothing.
  EventWriter() = default;

  /// `path` may be `-` for standard output. Events are added to the end of a file.
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
