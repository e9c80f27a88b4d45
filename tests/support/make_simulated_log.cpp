// Prints the project's own log or its truth. How the files in logs/ are made:
//
//   make_simulated_log log | gzip -9n > logs/simulated-office.clf.gz
//   make_simulated_log truth > logs/simulated-office.tum

#include <iostream>
#include <string_view>

#include "tests/support/carmen_text.h"
#include "tests/support/office_world.h"

int main(int argc, char** argv) {
  using loopgrid::test_support::CarmenDialect;
  const std::string_view what = argc == 2 ? argv[1] : "";
  const loopgrid::test_support::SimulatedRun run = loopgrid::test_support::OfficeRun();
  if (what == "log") {
    std::cout << CarmenText(run, CarmenDialect::kFlaser);
  } else if (what == "truth") {
    std::cout << TrueTrajectoryText(run);
  } else {
    std::cerr << "usage: make_simulated_log log|truth\n";
    return 2;
  }
  return std::cout.flush() ? 0 : 4;
}
