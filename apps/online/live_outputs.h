#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "apps/live/live_map.h"
#include "apps/live/live_viewer.h"
#include "apps/live/published_files.h"
#include "apps/live/refresher.h"
#include "apps/online/event_writer.h"
#include "apps/online/online_mapper.h"
#include "apps/online/online_options.h"
#include "apps/online/online_status.h"
#include "apps/online/source/line_queue.h"
#include "apps/online/source/line_source.h"

namespace loopgrid {

/// All that shows the map while it grows: the files that are refreshed, the page and the status.
/// Used by the mapping thread; no call takes long.
class LiveOutputs {
 public:
  /// Throws Error (kInput) if the page's address cannot be had.
  LiveOutputs(const OnlineOptions& options, const LineSource* source, const LineQueue* queue,
              EventWriter* events);

  /// Null if there is no page.
  const LiveViewer* view() const { return view_.get(); }

  /// Takes a scan. `is_new`: it came from the stream, not from the journal.
  void Add(const OnlineUpdate& update, bool is_new);

  /// Refreshes files and status when it is time. Has to be called often. Throws Error (kOutput) if
  /// the files could not be refreshed.
  void Tick(OnlineMapper* mapper);

  /// Ends the refreshing of files.
  void StopRefreshing();

  /// Call at the end: viewers get the final poses and the files in `folder`.
  void Finish(const Slam& slam, const std::string& folder);

 private:
  using Clock = std::chrono::steady_clock;

  void Refresh(const Slam& slam);
  void PublishStatus(OnlineMapper* mapper);
  void WarnOfScansLeftOut();

  const LineSource* source_;
  const LineQueue* queue_;
  EventWriter* events_;
  PublishedFiles published_;
  LiveMap map_;
  std::unique_ptr<LiveViewer> view_;
  std::unique_ptr<Refresher> refresher_;
  OnlineStatus status_;
  std::int64_t refreshed_scans_ = 0;
  bool has_warned_ = false;  // that some scans do not fit into the live map
  Clock::time_point next_status_ = Clock::now();
};

}  // namespace loopgrid
