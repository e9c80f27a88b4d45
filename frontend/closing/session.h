#pragma once

namespace loopgrid {

/// A drive that begins where the robot was switched on or put down. The nodes of a later session
/// may be anywhere in the map of the earlier ones until closures give them their place.
struct Session {
  int first_node = 0;
  bool localized = true;  ///< whether its place in the older map is known
};

}  // namespace loopgrid
