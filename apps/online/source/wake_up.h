#pragma once

#include "apps/net/descriptor.h"

namespace loopgrid {

/// A descriptor that becomes readable, and stays so, when Signal() is called. A thread that waits
/// in poll() includes it, so that another thread can end the wait.
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
