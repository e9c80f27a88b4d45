#include "apps/online/online_mapper.h"

#include <cstddef>
#include <utility>

namespace loopgrid {
namespace {

LogReaderOptions ReaderOptions(const RunOptions& options) {
  LogReaderOptions reader;
  reader.strict = options.strict;
  return reader;
}

}  // namespace

OnlineMapper::OnlineMapper(const RunOptions& options, Sink sink)
    : sink_(std::move(sink)), decoder_(options.log, ReaderOptions(options)), slam_(options.slam) {}

void OnlineMapper::AddLine(const ReceivedLine& line) {
  arrivals_.push_back(line.arrival);
  decoder_.AddLine(line.text, line.terminated, line.too_long);
  TakeScans();
  if (!decoder_.holds_scans()) arrivals_.clear();
}

void OnlineMapper::End() {
  decoder_.Finish();
  TakeScans();
}

void OnlineMapper::TakeScans() {
  Observation observation;
  while (decoder_.Next(&observation)) {
    clock_.Add(observation.timestamp);
    const TrackedScan tracked = slam_.AddScan(observation);
    sink_(Describe(tracked, observation));
  }
}

OnlineUpdate OnlineMapper::Describe(const TrackedScan& tracked, const Observation& observation) {
  OnlineUpdate update;
  update.tracked = tracked;
  update.line = decoder_.observation_line();
  update.timestamp = observation.timestamp;
  update.latency_seconds = SecondsSinceArrival(update.line);
  update.place = slam_.scan_place(tracked.scan);
  update.points = slam_.scan_points(tracked.scan);
  for (const int index : tracked.closures) {
    update.closures.push_back(slam_.closures()[static_cast<std::size_t>(index)]);
  }
  CountAccepted(tracked);
  if (tracked.optimized) {
    update.nodes = std::make_shared<NodeStates>(
        NodeStates{.poses = slam_.graph().poses, .covariances = slam_.NodeCovariances()});
  }
  return update;
}

double OnlineMapper::SecondsSinceArrival(std::int64_t line) {
  const std::int64_t first = decoder_.statistics().lines - std::ssize(arrivals_) + 1;
  arrivals_.erase(arrivals_.begin(), arrivals_.begin() + (line - first));
  const auto waited = std::chrono::steady_clock::now() - arrivals_.front();
  return std::chrono::duration<double>(waited).count();
}

void OnlineMapper::CountAccepted(const TrackedScan& tracked) {
  accepted_.resize(slam_.closures().size());
  for (const int index : tracked.closures) {
    const auto i = static_cast<std::size_t>(index);
    const bool accepted = slam_.closures()[i].outcome == ClosureOutcome::kAccepted;
    accepted_closures_ += (accepted ? 1 : 0) - (accepted_[i] ? 1 : 0);
    accepted_[i] = accepted;
  }
}

}  // namespace loopgrid
