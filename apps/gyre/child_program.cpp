// Another program behind a pipe. See child_program.h.
#include "child_program.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>

#ifndef _WIN32
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace gyre {

#ifdef _WIN32

std::string find_program(const std::string&) { return {}; }
ChildProgram::~ChildProgram() = default;
bool ChildProgram::start(const std::vector<std::string>&) { return false; }
bool ChildProgram::write(std::string_view) { return false; }
bool ChildProgram::finish() { return false; }

#else

std::string find_program(const std::string& name) {
  const char* const value = std::getenv("PATH");
  const std::string path = value != nullptr ? value : "/usr/bin:/bin";
  for (std::size_t begin = 0; begin <= path.size();) {
    std::size_t end = path.find(':', begin);
    if (end == std::string::npos) end = path.size();
    const std::string candidate = path.substr(begin, end - begin) + "/" + name;
    if (end > begin && access(candidate.c_str(), X_OK) == 0) return candidate;
    begin = end + 1;
  }
  return {};
}

ChildProgram::~ChildProgram() { finish(); }

bool ChildProgram::start(const std::vector<std::string>& arguments) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return false;
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  // A program that ends early shall be a message, not a signal.
  std::signal(SIGPIPE, SIG_IGN);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[0], 0);
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere >= 0) dup2(nowhere, 1);
    execv(argv[0], argv.data());
    _exit(127);
  }
  close(ends[0]);
  if (child < 0) {
    close(ends[1]);
    return false;
  }
  input_ = ends[1];
  process_ = child;
  return true;
}

bool ChildProgram::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(input_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(std::size_t(written));
  }
  return true;
}

bool ChildProgram::finish() {
  if (process_ < 0) return false;
  close(input_);
  int status = 0;
  while (waitpid(pid_t(process_), &status, 0) < 0 && errno == EINTR) {
  }
  process_ = input_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

#endif

}  // namespace gyre
