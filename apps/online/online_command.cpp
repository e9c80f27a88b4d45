#include "apps/online/online_command.h"

#include <malloc.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/cli/interrupt_watch.h"
#include "apps/cli/progress_bar.h"
#include "apps/live/live_viewer.h"
#include "apps/net/host_port.h"
#include "apps/online/live_outputs.h"
#include "apps/online/online_session.h"
#include "apps/online/session/session_folder.h"
#include "apps/online/source/connect_source.h"
#include "apps/online/source/follow_source.h"
#include "apps/online/source/listen_source.h"
#include "apps/online/source/pipe_source.h"
#include "apps/output/output_directory.h"
#include "apps/output/same_file.h"
#include "apps/output/session_names.h"
#include "apps/output/standard_output.h"
#include "apps/run/finish_run.h"
#include "apps/run/report.h"
#include "apps/run/run_outputs.h"
#include "backend/base/atomic_file.h"
#include "backend/base/error.h"
#include "backend/base/stopwatch.h"

namespace loopgrid {
namespace {

void Note(const std::string& text) { std::fprintf(stderr, "loopgrid: %s\n", text.c_str()); }

void CompleteOptions(OnlineOptions* options) {
  if (!options->resume.empty()) options->run.out = options->resume;
  options->run.slam.threads = options->threads;
}

std::unique_ptr<LineSource> OpenFollowSource(const OnlineOptions& options) {
  auto source = std::make_unique<FollowSource>(options.follow);
  if (!options.run.quiet && !source->has_file()) Note("waiting for the file " + source->name());
  return source;
}

std::unique_ptr<LineSource> OpenListenSource(const OnlineOptions& options) {
  const HostPort address = ParseHostPort(options.listen);
  auto source = std::make_unique<ListenSource>(
      ListenOptions{.address = address, .end_with_sender = options.once});
  if (!options.run.quiet) Note("waiting for a sender at " + source->name());
  if (!IsLoopback(address.host)) {
    Note("WARNING: " + source->name() + " is open to other machines: whoever can reach it can " +
         "send scans");
  }
  return source;
}

std::unique_ptr<LineSource> OpenSource(const OnlineOptions& options) {
  if (!options.follow.empty()) return OpenFollowSource(options);
  if (!options.listen.empty()) return OpenListenSource(options);
  if (!options.connect.empty()) {
    return std::make_unique<ConnectSource>(
        ConnectOptions{.address = ParseHostPort(options.connect), .end_with_sender = options.once});
  }
  return std::make_unique<PipeSource>(STDIN_FILENO, "standard input");
}

void Introduce(const OnlineOptions& options, const LineSource& source, const LiveViewer* view,
               EventWriter* events) {
  const std::string page = view == nullptr ? "" : view->url();
  if (view != nullptr && !view->is_loopback()) {
    Note("WARNING: " + page + " is open to other machines: whoever can reach it can watch");
  }
  if (view != nullptr && !options.run.quiet) Note("the page is at " + page);
  events->Start(options, source.name(), page);
  events->Flush();
}

/// The events must not overwrite a file that the session reads or writes. Throws Error (kUsage).
void RequireOwnPlaceForEvents(const OnlineOptions& options) {
  std::vector<std::string> taken = RunOutputNames();
  taken.insert(taken.end(), {kJournalName, kSessionName});
  for (const std::string& name : taken) {
    const std::string path = options.run.out + "/" + name;
    if (options.events == "-" || !IsSameFile(options.events, path)) continue;
    throw Error(ErrorCode::kUsage,
                "--events " + options.events + ": is a file of the session; take another name");
  }
  RequireOtherThanInput("--events", options.events, options.follow);
}

/// A session that followed its own journal would never end.
void RequireOtherThanJournal(const OnlineOptions& options) {
  if (!IsSameFile(options.follow, options.run.out + "/" + kJournalName)) return;
  throw Error(ErrorCode::kUsage, "--follow " + options.follow + ": is the session's own journal");
}

/// Runs a source on a thread of its own.
class SourceThread {
 public:
  SourceThread(LineSource* source, LineQueue* queue)
      : source_(source), queue_(queue), thread_([this] { Run(); }) {}

  ~SourceThread() {
    queue_->Close();
    source_->Stop();
    if (thread_.joinable()) thread_.join();
  }

  /// Call after the end of the stream: throws the error with which it ended, if any.
  void RethrowProblem() {
    if (thread_.joinable()) thread_.join();
    if (problem_) std::rethrow_exception(problem_);
  }

 private:
  void Run() {
    try {
      source_->Run(queue_);
    } catch (...) {
      problem_ = std::current_exception();
    }
  }

  LineSource* source_;
  LineQueue* queue_;
  std::exception_ptr problem_;
  std::thread thread_;
};

/// Prints the problems of the source.
void TellNotices(LineSource* source, ProgressBar* bar) {
  for (const std::string& notice : source->TakeNotices()) {
    bar->Clear();
    Note(source->name() + ": " + notice);
  }
}

/// Maps the lines of the stream until its end.
void MapStream(LineSource* source, LineQueue* queue, OnlineSession* session, LiveOutputs* live,
               ProgressBar* bar) {
  constexpr std::chrono::milliseconds kIdle(50);
  ReceivedLine line;
  while (true) {
    live->Tick(session->mapper());
    TellNotices(source, bar);
    bar->Update(0.0, session->mapper()->log().scans);
    if (!queue->Wait(kIdle)) continue;
    if (!queue->Pop(&line)) return;
    session->Add(std::move(line));
  }
}

/// Writes the files of a run.
RunReport WriteFiles(const Stopwatch& stopwatch, const RunOptions& options, Journal* journal,
                     OnlineMapper* mapper, OutputDirectory* outputs, ProgressBar* bar) {
  journal->Sync();
  RunReport report;
  report.options = options;
  report.log = mapper->log();
  report.data_seconds = mapper->data_seconds();
  FinishRun(stopwatch, mapper->slam(), outputs, bar, &report);
  return report;
}

void PrintSummary(const OnlineOptions& options, const RunReport& report) {
  const std::string summary = FormatSummary(report);
  if (options.events == "-") {
    std::fputs(summary.c_str(), stderr);
  } else {
    PrintToStandardOutput(summary);
  }
}

}  // namespace

void OnlineCommand(OnlineOptions options) {
  const Stopwatch stopwatch;
  options.Validate();
  // Memory is often allocated in one thread and freed in another. With a pool for each thread, free
  // memory would accumulate in the pools.
  mallopt(M_ARENA_MAX, 2);
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  CompleteOptions(&options);
  RequireOwnPlaceForEvents(options);
  RequireOtherThanJournal(options);
  const std::unique_ptr<LineSource> source = OpenSource(options);
  OutputDirectory outputs(options.run.out, RunOutputNames());
  std::atomic<bool> stopped = false;
  const auto stop = [&] {
    stopped = true;
    source->Stop();
  };
  const auto clean_up = [&outputs] {
    outputs.Discard();
    AtomicFile::RemoveTemporaries();
  };
  const InterruptWatch watch({stop, clean_up});

  SessionRequest request = {.run = options.run,
                            .resume = options.resume,
                            .continued = options.continued,
                            .given = options.given};
  SessionFolder folder(&request, &outputs);
  options.run = request.run;
  EventWriter events = options.events.empty() ? EventWriter() : EventWriter(options.events);
  LineQueue queue;
  LiveOutputs live(options, source.get(), &queue, &events);
  Introduce(options, *source, live.view(), &events);
  ProgressBar bar(options.run.quiet);
  OnlineSession session(
      options.run, folder.journal(), &events,
      [&live](const OnlineUpdate& update, bool is_new) { live.Add(update, is_new); });
  session.Replay(!options.resume.empty());

  SourceThread reading(source.get(), &queue);
  MapStream(source.get(), &queue, &session, &live, &bar);
  TellNotices(source.get(), &bar);
  session.End();
  if (session.mapper()->log().scans == 0) reading.RethrowProblem();
  RequireScans(source->name(), session.mapper()->log());
  live.StopRefreshing();
  const RunReport report =
      WriteFiles(stopwatch, options.run, folder.journal(), session.mapper(), &outputs, &bar);
  events.End(report.log.lines, report.log.scans, stopped);
  events.Flush();
  live.Finish(*session.mapper()->slam(), options.run.out);
  PrintSummary(options, report);
  reading.RethrowProblem();
}

}  // namespace loopgrid
