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

/// What the refreshed files are made of, beside the map.
struct RefreshContent {
  Trajectory trajectory;
  PoseGraph<SE2> graph;
};

/// Writes map.png, map.pgm, map.yaml, trajectory.tum and graph.g2o again and again while mapping
/// goes on, each whole or not at all, on a thread of its own. A map that would be too large for an
/// image is drawn coarser; one that does not fit into the memory stays as it was refreshed last.
class Refresher {
 public:
  /// `map` and `published` must live longer; `published` may be null. `interval` in seconds.
  Refresher(std::string folder, double interval, LiveMap* map, PublishedFiles* published);

  /// Waits for the files that are being written.
  ~Refresher();
  Refresher(const Refresher&) = delete;
  Refresher& operator=(const Refresher&) = delete;

  /// Whether it is time for new content. That is at intervals, and not before ten times as long as
  /// the last refresh took. Throws Error (kOutput) if that one failed.
  bool IsDue() const;

  /// Writes this; returns at once.
  void Refresh(RefreshContent content);

  /// The number of scans in the files, once after each refresh.
  std::optional<std::int64_t> TakeSaved();

  /// Something to tell about the map files, once: they are drawn coarser, or were left out.
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

  std::string last_note_;  // of the thread alone
  std::thread thread_;
};

}  // namespace loopgrid
