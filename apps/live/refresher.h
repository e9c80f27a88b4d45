#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "apps/live/live_map.h"
#include "apps/live/published_files.h"
#include "backend/graph/pose_graph.h"
#include "frontend/evaluation/tum_file.h"

namespace loopgrid {

/// The content of the refreshed files, without the map.
struct RefreshContent {
  Trajectory trajectory;
  PoseGraph<SE2> graph;
};

/// Writes map.png, map.pgm, map.yaml, trajectory.tum and graph.g2o at intervals while mapping goes
/// on, on a thread of its own. Each file is replaced completely or not at all. A map that would be
/// too large for an image is drawn coarser. If it does not fit into memory, the files of the last
/// refresh stay.
class Refresher {
 public:
  /// `map` and `published` must live longer; `published` may be null. `interval` in seconds.
  Refresher(std::string folder, double interval, LiveMap* map, PublishedFiles* published);

  /// Waits until the files being written are complete.
  ~Refresher();
  Refresher(const Refresher&) = delete;
  Refresher& operator=(const Refresher&) = delete;

  /// Whether it is time for the next refresh: after the interval, and after ten times the time that
  /// the last refresh took. Throws Error (kOutput) if the last refresh failed.
  bool IsDue() const;

  /// Begins to write the files; returns at once.
  void Refresh(RefreshContent content);

  /// After each refresh, returns once the number of scans in the files.
  std::optional<std::int64_t> TakeSaved();

  /// A message about the map files, returned once: they are drawn coarser, or were left out.
  std::optional<std::string> TakeNote();

 private:
  using Clock = std::chrono::steady_clock;

  struct MapFiles {
    std::string png;
    std::string pgm;
    std::string yaml;
  };

  void Serve();
  void Write(const RefreshContent& content);
  std::optional<MapFiles> DrawMap();
  void Note(std::string text);
  void WriteOne(const std::string& name, std::string content) const;

  std::string folder_;
  std::chrono::duration<double> interval_;
  LiveMap* map_;
  PublishedFiles* published_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<RefreshContent> content_;  // to be written, or being written
  std::optional<std::int64_t> saved_;
  std::optional<std::string> note_;  // not taken yet
  std::exception_ptr problem_;
  Clock::time_point next_ = Clock::now();
  bool closing_ = false;

  std::string last_note_;  // used by the thread only
  std::thread thread_;
};

}  // namespace loopgrid
