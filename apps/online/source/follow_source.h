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

/// Lines of a file that is being written, from its start on, without end. The last line waits until
/// it is complete. A file that is not there yet is waited for. When another file takes the name
/// (rotation), the old one is read to its end first, and left once the new one is not empty. A file
/// that shrinks is read from its beginning again.
///
/// The file is looked at whenever it changes, and every 50 ms in any case. Two things can happen
/// unseen between two looks: a file shrinks and grows beyond its old size, and a file is rotated
/// twice, whose middle one is then not read.
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
  Descriptor file_;          // none: it is not there yet
  std::int64_t offset_ = 0;  // how far it was read
  StartCheck check_;
  SharedCounters counters_;
};

}  // namespace loopgrid
