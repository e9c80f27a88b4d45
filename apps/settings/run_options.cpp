#include "apps/settings/run_options.h"

#include "apps/settings/mapping_options.h"

namespace loopgrid {

void RunOptions::Validate() const {
  ValidateMapping(*this);
  slam.Validate();
}

}  // namespace loopgrid
