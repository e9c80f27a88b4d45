#include "apps/online/online_session.h"

#include <fmt/format.h>

#include <utility>

namespace loopgrid {

OnlineSession::OnlineSession(const RunOptions& options, Journal* journal, EventWriter* events,
                             Sink sink)
    : journal_(journal),
      events_(events),
      sink_(std::move(sink)),
      mapper_(options, [this](const OnlineUpdate& update) { Publish(update); }) {}

void OnlineSession::Publish(const OnlineUpdate& update) {
  sink_(update, !replaying_);
  if (!replaying_) events_->Scan(update);
}

void OnlineSession::Replay(bool sent_again) {
  if (sent_again) filter_.emplace();
  replaying_ = true;
  journal_->Read([this](ReceivedLine line) {
    if (!line.terminated) {
      open_end_ = std::move(line);
      return;
    }
    if (filter_) filter_->AddJournalLine(line);
    mapper_.AddLine(line);
  });
  replaying_ = false;
  if (sent_again) events_->Resumed(mapper_.log().lines, mapper_.log().scans);
}

void OnlineSession::Add(ReceivedLine line) {
  if (filter_) {
    Filter(std::move(line));
  } else {
    Take(std::move(line));
  }
  events_->Flush();
}

void OnlineSession::Filter(ReceivedLine line) {
  filter_->Add(std::move(line), [this](ReceivedLine fresh) { Take(std::move(fresh)); });
  if (filter_->done()) TellKnownLines();
}

void OnlineSession::TellKnownLines() {
  if (filter_->known_lines() > 0) events_->Known(filter_->known_lines());
  filter_.reset();
}

void OnlineSession::End() {
  if (filter_) {
    filter_->End([this](ReceivedLine fresh) { Take(std::move(fresh)); });
    TellKnownLines();
  }
  if (open_end_) TakeOpenEnd();
  mapper_.End();
  events_->Flush();
}

void OnlineSession::Take(ReceivedLine line) {
  if (journal_->empty()) KeepReadable(&line);
  if (open_end_ && journal_->IsContinuedBy(line)) {
    open_end_.reset();
    journal_->Complete(line);
  } else {
    if (open_end_) TakeOpenEnd();
    journal_->Append(line);
  }
  Map(line);
}

/// The journal's last line has no end, and the stream does not continue it: maps it as it is.
void OnlineSession::TakeOpenEnd() {
  Map(*open_end_);
  open_end_.reset();
}

void OnlineSession::Map(const ReceivedLine& line) {
  const std::int64_t malformed = mapper_.log().malformed;
  mapper_.AddLine(line);
  const LogStatistics& log = mapper_.log();
  if (log.malformed == malformed) return;
  const bool told = log.malformed == std::ssize(log.first_problems);
  events_->Warning(told ? log.first_problems.back()
                        : fmt::format("{}:{}: malformed", journal_->path(), log.lines));
}

}  // namespace loopgrid
