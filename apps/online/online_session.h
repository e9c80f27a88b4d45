#pragma once

#include <functional>
#include <optional>
#include <string>

#include "apps/online/event_writer.h"
#include "apps/online/online_mapper.h"
#include "apps/online/session/journal.h"
#include "apps/online/session/resume_filter.h"
#include "apps/settings/run_options.h"

namespace loopgrid {

/// Lines on their way through the mapping thread: into the journal, then through the mapper, then
/// to whoever waits for their events. What is in the journal at the start goes through the mapper
/// alike.
class OnlineSession {
 public:
  /// Gets every scan; `is_new`: it came in the stream, not out of the journal.
  using Sink = std::function<void(const OnlineUpdate& update, bool is_new)>;

  /// `events` gets the new scans only.
  OnlineSession(const RunOptions& options, Journal* journal, EventWriter* events, Sink sink);

  /// Takes what the journal holds. If `sent_again`, lines of the stream may be among it.
  void Replay(bool sent_again);

  /// The stream's next line. Throws Error.
  void Add(ReceivedLine line);

  /// The stream is over.
  void End();

  OnlineMapper* mapper() { return &mapper_; }

 private:
  void Publish(const OnlineUpdate& update);
  void Filter(ReceivedLine line);
  void TellKnownLines();
  void Take(ReceivedLine line);
  void TakeOpenEnd();
  void Map(const ReceivedLine& line);

  Journal* journal_;
  EventWriter* events_;
  Sink sink_;
  OnlineMapper mapper_;
  bool replaying_ = false;
  std::optional<ResumeFilter> filter_;
  std::optional<ReceivedLine> open_end_;  // the journal's last line, if it may still go on
};

}  // namespace loopgrid
