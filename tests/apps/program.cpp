#include "tests/apps/program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace loopgrid::test_support {
namespace {

void Require(bool good, const char* what) {
  if (!good) throw std::system_error(errno, std::generic_category(), what);
}

[[noreturn]] void Exec(const std::vector<std::string>& arguments) {
  std::vector<std::string> copies = arguments;
  copies.insert(copies.begin(), LOOPGRID_PROGRAM);
  std::vector<char*> pointers;
  pointers.reserve(copies.size() + 1);
  for (std::string& argument : copies) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(LOOPGRID_PROGRAM, pointers.data());
  _exit(127);
}

/// Appends what there is to read; false at the end of the stream.
bool Drain(int descriptor, std::string* text) {
  std::array<char, 4096> buffer;
  const ssize_t count = read(descriptor, buffer.data(), buffer.size());
  if (count <= 0) return count < 0 && errno == EINTR;
  text->append(buffer.data(), static_cast<size_t>(count));
  return true;
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, const std::function<void()>& before) {
  int output[2];
  int errors[2];
  Require(pipe2(output, O_CLOEXEC) == 0 && pipe2(errors, O_CLOEXEC) == 0, "pipe");
  child_ = fork();
  Require(child_ >= 0, "fork");
  if (child_ == 0) {
    dup2(output[1], STDOUT_FILENO);
    dup2(errors[1], STDERR_FILENO);
    if (before) before();
    Exec(arguments);
  }
  close(output[1]);
  close(errors[1]);
  output_ = output[0];
  errors_ = errors[0];
}

Program::~Program() {
  if (child_ > 0) {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  close(output_);
  close(errors_);
}

void Program::Send(int signal) const { Require(kill(child_, signal) == 0, "kill"); }

ProgramResult Program::Wait() {
  ProgramResult result;
  std::array<pollfd, 2> streams = {pollfd{output_, POLLIN, 0}, pollfd{errors_, POLLIN, 0}};
  const std::array<std::string*, 2> texts = {&result.output, &result.errors};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (poll(streams.data(), streams.size(), -1) < 0) continue;
    for (size_t i = 0; i < streams.size(); ++i) {
      // poll() ignores streams with a negative descriptor.
      if (streams[i].revents != 0 && !Drain(streams[i].fd, texts[i])) streams[i].fd = -1;
    }
  }
  int status = 0;
  Require(waitpid(child_, &status, 0) == child_, "waitpid");
  child_ = -1;
  result.status = WIFSIGNALED(status) ? 1000 + WTERMSIG(status) : WEXITSTATUS(status);
  return result;
}

ProgramResult RunProgram(const std::vector<std::string>& arguments,
                         const std::function<void()>& before) {
  return Program(arguments, before).Wait();
}

}  // namespace loopgrid::test_support
