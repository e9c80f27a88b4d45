#pragma once

#include "apps/net/descriptor.h"

namespace loopgrid {

/// A descriptor that becomes readable, for good, once Signal() is called: what a thread that waits
/// in poll() adds to what it waits for, so that another thread can call it back.
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
