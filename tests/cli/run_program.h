// Starts the gyre program as a user does, and collects what it printed and how it ended.
#pragma once

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gyre {

struct Finished {
  int code = -1;  // exit status; 128 + signal if it was killed
  std::string out, err;
};

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::string program_path() {
#ifdef GYRE_CLI
  return GYRE_CLI;
#else
  const char* path = std::getenv("GYRE_CLI");
  return path ? path : "gyre";
#endif
}

// `interrupt_when`: once this file exists, Ctrl-C is sent a moment later.
inline Finished run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                            const std::string& interrupt_when_matching = {}) {
  const std::filesystem::path out = folder / "stdout.txt", err = folder / "stderr.txt";
  const std::string program = program_path();
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const std::string out_path = out.string(), err_path = err.string(), folder_path = folder.string();

  const pid_t child = fork();
  if (child == 0) {
    const int out_file = open(out_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_file = open(err_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (out_file < 0 || err_file < 0 || chdir(folder_path.c_str()) != 0) _exit(125);
    dup2(out_file, 1);
    dup2(err_file, 2);
    execv(program.c_str(), argv.data());
    _exit(126);
  }
  if (!interrupt_when_matching.empty()) {
    // Waits until a file whose name begins so has something in it: then the simulation is under way.
    for (bool running = false; !running;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        std::error_code error;
        if (name.rfind(interrupt_when_matching, 0) == 0 &&
            std::filesystem::file_size(entry.path(), error) > 0)
          running = true;
      }
      if (waitpid(child, nullptr, WNOHANG) != 0) return {};
    }
    kill(child, SIGINT);
  }
  int status = 0;
  waitpid(child, &status, 0);
  Finished done;
  done.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  done.out = file_text(out);
  done.err = file_text(err);
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return done;
}

}  // namespace gyre
