#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "apps/cli/command.h"
#include "apps/cli/command_line.h"
#include "apps/eval/eval_arguments.h"
#include "apps/online/online_arguments.h"
#include "apps/optimize/optimize_arguments.h"
#include "apps/output/standard_output.h"
#include "apps/plot/plot_arguments.h"
#include "apps/replay/replay_arguments.h"
#include "apps/run/run_arguments.h"
#include "apps/view/view_argument.h"
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

/// Opens the standard streams that the caller has closed. Otherwise the next file that is opened
/// would get the number of such a stream, and printed text would go into that file. Writing to
/// these streams still fails.
void OccupyStandardStreams() {
  int descriptor = 0;
  do {
    descriptor = open("/dev/null", O_RDONLY);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor >= 0) close(descriptor);
}

/// The options of all commands.
struct Options {
  RunOptions run;
  OnlineOptions online;
  EvalOptions eval;
  OptimizeOptions optimize;
  PlotOptions plot;
  ReplayOptions replay;
};

Program DescribeProgram(Options* options) {
  return {.name = "loopgrid",
          .version = LOOPGRID_VERSION,
          .summary =
              "Graph-based 2D laser SLAM: makes map, trajectory and graph from a robot's log. Its "
              "back-end\n"
              "alone finds the best poses of a pose graph, 2D or 3D, and their covariances.",
          .footer =
              "loopgrid COMMAND --help explains a command's options.\n"
              "Exit status: 0 done, 2 wrong usage, 3 an input cannot be used, 4 an output cannot "
              "be written,\n"
              "128 + n ended by signal n.",
          .commands = {DescribeRun(&options->run), DescribeOnline(&options->online, DescribeView()),
                       DescribeEval(&options->eval), DescribeOptimize(&options->optimize),
                       DescribePlot(&options->plot), DescribeReplay(&options->replay)}};
}

/// Returns the exit status. Throws Error.
int RunProgram(int argc, char** argv) {
  Options options;
  const Program program = DescribeProgram(&options);
  const Invocation invocation = ParseCommandLine(program, argc, argv);
  if (invocation.lacks_command) {
    std::fputs(invocation.answer.c_str(), stderr);
    return ExitStatus(ErrorCode::kUsage);
  }
  if (invocation.command == nullptr) {
    PrintToStandardOutput(invocation.answer);
  } else {
    Execute(*invocation.command);
  }
  return 0;
}

/// Prints the message as one line. An error of printing is ignored: there is no place to report it.
int Complain(std::string message, int status) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fprintf(stderr, "loopgrid: %s\n", message.c_str());
  return status;
}

int Main(int argc, char** argv) {
  OccupyStandardStreams();
  // When these signals are ignored, write() fails at a closed pipe or at the limit on file sizes.
  // The error then names the file.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return RunProgram(argc, argv);
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
