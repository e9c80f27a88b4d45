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

/// Takes lines through the mapping thread: each line goes to the journal, then to the mapper, and
/// then its events are written. The lines that the journal has at the start go to the mapper in the
/// same way.
class OnlineSession {
 public:
  /// Is called for every scan. `is_new`: it came from the stream, not from the journal.
  using Sink = std::function<void(const OnlineUpdate& update, bool is_new)>;

  /// Events are written for new scans only.
  OnlineSession(const RunOptions& options, Journal* journal, EventWriter* events, Sink sink);

  /// Maps the lines of the journal. `sent_again`: the stream may contain the same lines again.
  void Replay(bool sent_again);

  /// Takes the stream's next line. Throws Error.
  void Add(ReceivedLine line);

  /// Call at the end of the stream.
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
  std::optional<ReceivedLine> open_end_;  // the journal's last line, if the stream may continue it
};

}  // namespace loopgrid
