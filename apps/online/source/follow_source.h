#pragma once

#include <cstdint>
#include <string>

#include "apps/net/descriptor.h"
#include "apps/online/source/line_inlet.h"
#include "apps/online/source/line_source.h"
#include "apps/online/source/shared_counters.h"
#include "apps/online/source/start_check.h"
#include "apps/online/source/wake_up.h"

namespace loopgrid {

/// Lines of a file that is being written, from its start on, without end; the last line waits until
/// it is complete. A file that is not there yet is waited for. When the name passes to another file
/// (rotation), the old one is read to its end first, and left once there is something in the new
/// one. A file that shrinks is read from its beginning again.
///
/// The file is looked at whenever it changes, and every 50 ms in any case, or when the queue has
/// room again. What nobody can tell afterwards is missed: a file that was cut and has outgrown its
/// old size by then, the first one of two rotations.
class FollowSource : public LineSource {
 public:
  /// Throws Error (kInput) if there is no such folder, or if what is there is no file that can be
  /// read.
  explicit FollowSource(std::string path);

  /// Ends by Stop() only. Throws Error (kInput) if the file, or one that takes its place, cannot be
  /// read, and if it begins as gzip or binary data do.
  void Run(LineQueue* queue) override;
  void Stop() override { wake_up_.Signal(); }
  std::string name() const override { return path_; }

  /// Before Run(): whether the file is there already.
  bool has_file() const { return static_cast<bool>(file_); }
  SourceCounters counters() const override { return counters_.Snapshot(); }

 private:
  bool ReadToEnd(LineInlet* inlet);
  bool HasShrunk() const;
  Descriptor OpenSuccessor() const;

  std::string path_;
  WakeUp wake_up_;
  Descriptor file_;          // none: it is not there yet
  std::int64_t offset_ = 0;  // how far it was read
  StartCheck check_;
  SharedCounters counters_;
};

}  // namespace loopgrid
