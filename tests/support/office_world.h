#pragma once

#include <Eigen/Core>
#include <vector>

#include "tests/support/simulator.h"

namespace loopgrid::test_support {

/// One floor of an office, 32 m x 22 m: a corridor that goes round a core, rooms of different sizes
/// on both sides of it, with doors, furniture, columns and a glass front.
World OfficeWorld();

/// A drive of about 150 m through it: once around the corridor with visits to rooms, which closes a
/// loop of 110 m, then along the first part again.
std::vector<Eigen::Vector2d> OfficeRoute();

/// The run that is in logs/simulated-office.clf.gz.
SimulatedRun OfficeRun();

}  // namespace loopgrid::test_support
