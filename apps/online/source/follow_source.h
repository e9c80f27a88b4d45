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

/// Lines of a file that is being written, from its beginning on, without end. The last line is
/// passed on when it is complete. If the file does not exist, it waits for it. When another file
/// takes the name (rotation), the old file is read to its end first. It is closed when the new one
/// is not empty. A file that shrinks is read from its beginning again.
///
/// The file is checked whenever it changes, and every 50 ms. Two things between two checks are not
/// noticed: a file that shrinks and grows beyond its old size; and a second rotation, so that the
/// file in the middle is not read.
class FollowSource : public LineSource {
 public:
  /// Throws Error (kInput) if the folder does not exist, or if the name belongs to something that
  /// is no regular file or cannot be read.
  explicit FollowSource(std::string path);

  /// Ends by Stop() only. Throws Error (kInput) if the file, or one that takes its name, cannot be
  /// read, or is gzipped or binary.
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
  Descriptor file_;          // none while it does not exist
  std::int64_t offset_ = 0;  // number of bytes read
  StartCheck check_;
  SharedCounters counters_;
};

}  // namespace loopgrid
