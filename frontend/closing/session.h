#pragma once

namespace loopgrid {

/// A drive from where the robot was switched on or carried to. The nodes of a later session may be
/// anywhere in the map of those before until a closure places them.
struct Session {
  int first_node = 0;
  bool localized = true;  ///< whether its place in the older map is known
};

}  // namespace loopgrid
