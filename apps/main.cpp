#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <variant>

#include "apps/cli/command_line.h"
#include "apps/eval/eval_command.h"
#include "apps/online/online_command.h"
#include "apps/optimize/optimize_command.h"
#include "apps/output/standard_output.h"
#include "apps/plot/plot_command.h"
#include "apps/replay/replay_command.h"
#include "apps/run/run_command.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

int ExitStatus(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage:
      return 2;
    case ErrorCode::kInput:
      return 3;
    case ErrorCode::kOutput:
      return 4;
  }
  return 1;
}

/// Opens the standard streams that the caller has closed, so that no file of ours gets their
/// numbers and what is printed into it. Writing to them still fails, as it should.
void OccupyStandardStreams() {
  int descriptor = 0;
  do {
    descriptor = open("/dev/null", O_RDONLY);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor >= 0) close(descriptor);
}

void Execute(const RunOptions& options) { RunCommand(options); }
void Execute(const OnlineOptions& options) { OnlineCommand(options); }
void Execute(const EvalOptions& options) { EvalCommand(options); }
void Execute(const OptimizeOptions& options) { OptimizeCommand(options); }
void Execute(const PlotOptions& options) { PlotCommand(options); }
void Execute(const ReplayOptions& options) { ReplayCommand(options); }
void Execute(const Answer& answer) { PrintToStandardOutput(answer.text); }

/// One line, whatever the message has in it; nobody is left to tell if this fails.
int Complain(std::string message, int status) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fprintf(stderr, "loopgrid: %s\n", message.c_str());
  return status;
}

int Main(int argc, char** argv) {
  OccupyStandardStreams();
  // A closed pipe or a limit on file sizes is then an error of write(), which says what and where.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    std::visit([](const auto& command) { Execute(command); }, ParseCommandLine(argc, argv));
    return 0;
  } catch (const Error& error) {
    return Complain(error.what(), ExitStatus(error.code()));
  } catch (const std::bad_alloc&) {
    return Complain("out of memory", 1);
  } catch (const std::exception& error) {
    return Complain(error.what(), 1);
  }
}

}  // namespace
}  // namespace loopgrid

int main(int argc, char** argv) { return loopgrid::Main(argc, argv); }
