#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace loopgrid::test_support {

/// A value of /proc/self/status, such as "VmRSS:" (resident memory now) or "VmHWM:" (its maximum so
/// far), in MB; 0 if it is not there.
inline double ProcessStatusMb(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    std::istringstream fields(line);
    std::string field;
    double kilobytes = 0.0;
    if (fields >> field >> kilobytes && field == name) return kilobytes / 1024.0;
  }
  return 0.0;
}

/// Runs this program with other arguments and returns the number that it prints; 0 if it prints
/// none. The new process does not count memory that this one has used.
inline double AskThisProgram(const std::string& arguments) {
  std::array<char, 4096> path{};
  if (readlink("/proc/self/exe", path.data(), path.size() - 1) < 0) return 0.0;
  FILE* const output = popen(fmt::format("'{}' {}", path.data(), arguments).c_str(), "r");
  if (output == nullptr) return 0.0;
  double number = 0.0;
  if (std::fscanf(output, "%lf", &number) != 1) number = 0.0;
  pclose(output);
  return number;
}

}  // namespace loopgrid::test_support
