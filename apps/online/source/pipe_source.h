#pragma once

#include <string>

#include "apps/online/source/line_source.h"
#include "apps/online/source/wake_up.h"

namespace loopgrid {

/// Lines from a descriptor: standard input, a pipe, a terminal. Each line is passed on as soon as
/// it is complete. The stream ends when all writers have closed it.
class PipeSource : public LineSource {
 public:
  /// Does not close `descriptor`. Throws Error (kInput) if it cannot be read from.
  PipeSource(int descriptor, std::string name);

  /// Throws Error (kInput) for a stream that is gzipped or binary.
  void Run(LineQueue* queue) override;
  void Stop() override { wake_up_.Signal(); }
  std::string name() const override { return name_; }

 private:
  bool WaitForBytes() const;

  int descriptor_;
  std::string name_;
  WakeUp wake_up_;
};

}  // namespace loopgrid
