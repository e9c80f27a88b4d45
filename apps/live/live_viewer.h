#pragma once

#include <functional>
#include <memory>
#include <string>

#include "apps/live/live_map.h"
#include "apps/live/online_update.h"
#include "apps/live/published_files.h"

namespace loopgrid {

/// Shows the map while it grows. Runs from its construction until it is destroyed. The mapping
/// thread calls it; only Finish() may take long.
class LiveViewer {
 public:
  LiveViewer() = default;
  virtual ~LiveViewer() = default;
  LiveViewer(const LiveViewer&) = delete;
  LiveViewer& operator=(const LiveViewer&) = delete;

  /// Where it can be watched.
  virtual std::string url() const = 0;

  /// Whether only this machine can reach it.
  virtual bool is_loopback() const = 0;

  /// Shows an update. If the index of its scan is negative, it contains only nodes and closures.
  virtual void Add(const OnlineUpdate& update) = 0;

  /// Shows that mapping has ended. Waits a short time until everything is sent.
  virtual void Finish() = 0;
};

/// The option of a command that starts a viewer. The program hands it to the commands that have a
/// live map, so that they need not know the viewer.
struct LiveViewerOption {
  std::string name;  ///< with its dashes; for example `--view`
  std::string unit;  ///< what stands for the value in the help
  std::string help;

  /// Throws Error (kUsage) if the option cannot have this value.
  std::function<void(const std::string& value)> check;

  /// Starts the viewer; map and files must live longer than it. Throws Error: kUsage if the option
  /// cannot have this value, kInput if its address cannot be used.
  std::function<std::unique_ptr<LiveViewer>(const std::string& value, const LiveMap* map,
                                            const PublishedFiles* files)>
      start;
};

}  // namespace loopgrid
