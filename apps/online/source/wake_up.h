#pragma once

#include "apps/net/descriptor.h"

namespace loopgrid {

/// A descriptor that becomes readable for good once Signal() is called. A thread that waits in
/// poll() waits for it too, so that another thread can end the waiting.
class WakeUp {
 public:
  /// Throws std::system_error if the system has no descriptor left.
  WakeUp();

  void Signal() const;
  bool signalled() const;
  int descriptor() const { return descriptor_.get(); }

 private:
  Descriptor descriptor_;
};

}  // namespace loopgrid
