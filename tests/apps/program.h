#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace loopgrid::test_support {

/// The result of a run of the program `loopgrid`.
struct ProgramResult {
  int status = 0;      ///< exit status; 1000 + the signal's number if a signal killed it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// The program `loopgrid` as a child process. Standard output and error go to pipes.
class Program {
 public:
  /// Starts it. `before` runs in the child just before the program does: to set limits, to close or
  /// replace descriptors.
  explicit Program(const std::vector<std::string>& arguments,
                   const std::function<void()>& before = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void Send(int signal) const;

  /// Reads what the program prints until it ends.
  ProgramResult Wait();

 private:
  pid_t child_ = -1;
  int output_ = -1;
  int errors_ = -1;
};

/// Starts the program and waits for its end.
ProgramResult RunProgram(const std::vector<std::string>& arguments,
                         const std::function<void()>& before = {});

}  // namespace loopgrid::test_support
