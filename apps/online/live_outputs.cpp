#include "apps/online/live_outputs.h"

#include <fmt/format.h>
#include <malloc.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "apps/run/run_outputs.h"

namespace loopgrid {
namespace {

constexpr std::chrono::milliseconds kBetweenStatuses(250);

std::string ReadWholeFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

LiveMapOptions MapOptions(const OnlineOptions& options) {
  LiveMapOptions map;
  map.grid.resolution = options.run.resolution;
  return map;
}

}  // namespace

LiveOutputs::LiveOutputs(const OnlineOptions& options, const LineSource* source,
                         const LineQueue* queue, EventWriter* events)
    : source_(source),
      queue_(queue),
      events_(events),
      map_(MapOptions(options)),
      refresher_(std::make_unique<Refresher>(options.run.out, options.interval, &map_,
                                             options.view.empty() ? nullptr : &published_)) {
  status_.source = source_->name();
  if (options.view.empty()) return;
  view_ = options.viewer.start(options.view, &map_, &published_);
}

void LiveOutputs::Add(const OnlineUpdate& update, bool is_new) {
  map_.Add(update);
  if (view_) view_->Add(update);
  ++status_.scans;
  if (update.tracked.node >= 0) ++status_.nodes;
  if (!update.tracked.matched) ++status_.unmatched;
  // The search for the robot in the old map used much memory. Return it to the system.
  if (update.tracked.localized && !status_.localized) malloc_trim(0);
  status_.localized = update.tracked.localized;
  if (is_new) status_.latency.Add(update.latency_seconds);
}

void LiveOutputs::Tick(OnlineMapper* mapper) {
  if (const auto scans = refresher_->TakeSaved()) events_->Saved(*scans);
  if (const auto note = refresher_->TakeNote()) events_->Warning(*note);
  if (refresher_->IsDue() && status_.scans > refreshed_scans_) Refresh(*mapper->slam());
  if (Clock::now() >= next_status_) PublishStatus(mapper);
  events_->Flush();
}

void LiveOutputs::StopRefreshing() { refresher_.reset(); }

void LiveOutputs::Finish(const Slam& slam, const std::string& folder) {
  if (!view_) return;
  OnlineUpdate result;
  result.tracked.scan = -1;  // no scan, only the final poses of the nodes
  result.nodes = std::make_shared<NodeStates>(
      NodeStates{.poses = slam.graph().poses, .covariances = slam.NodeCovariances()});
  map_.Add(result);
  view_->Add(result);
  map_.WaitUntilCurrent();
  for (const char* name : {"map.png", "map.pgm", "map.yaml", "trajectory.tum", "graph.g2o"}) {
    const std::string path = folder + "/" + name;
    std::error_code ignored;
    const bool exists = std::filesystem::exists(path, ignored);  // a map may have been left out
    published_.Put(name,
                   exists ? std::make_shared<const std::string>(ReadWholeFile(path)) : nullptr);
  }
  view_->Finish();
}

void LiveOutputs::Refresh(const Slam& slam) {
  refreshed_scans_ = status_.scans;
  refresher_->Refresh({.trajectory = StampPoses(slam, slam.ScanPoses()), .graph = slam.graph()});
}

void LiveOutputs::WarnOfScansLeftOut() {
  if (has_warned_ || map_.counters().left_out == 0) return;
  has_warned_ = true;
  events_->Warning(fmt::format(
      "the live map is without scans that are too far out for cells of {:.6g} m; the map "
      "at the end has larger cells instead, or says which scans it is without",
      map_.resolution()));
}

void LiveOutputs::PublishStatus(OnlineMapper* mapper) {
  next_status_ = Clock::now() + kBetweenStatuses;
  SourceCounters counters = source_->counters();
  if (counters.last_problem != status_.counters.last_problem) {
    events_->Warning(source_->name() + ": " + counters.last_problem);
  }
  status_.counters = std::move(counters);
  WarnOfScansLeftOut();
  status_.queue = queue_->counters();
  status_.log = mapper->log();
  status_.constraints = std::ssize(mapper->slam()->graph().constraints);
  status_.closures_tried = std::ssize(mapper->slam()->closures());
  status_.closures_accepted = mapper->accepted_closures();
  published_.Put("status.json", std::make_shared<const std::string>(FormatStatus(status_)));
}

}  // namespace loopgrid
