#pragma once

#include <stdexcept>
#include <string>

namespace loopgrid {

/// The kind of an error. It decides the exit status of the program (2, 3, 4).
enum class ErrorCode {
  kUsage,   ///< a wrong option, or an option out of range
  kInput,   ///< an input that is missing, unreadable, malformed or empty
  kOutput,  ///< an output that cannot be written
};

/// Bad input or a bad environment. The message is one line and begins with `file:line:` or `file:`
/// where there is one. Numerical outcomes ("no match", "not converged") are return values instead.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message);

  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace loopgrid
