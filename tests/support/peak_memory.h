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

/// A value of /proc/self/status, such as "VmRSS:" (resident memory now) or "VmHWM:" (the most there
/// was), in MB; 0 if it is not there.
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

/// The number that this program prints when it is run with other arguments: memory that has been
/// used before does not count there. 0 if it does not print one.
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
