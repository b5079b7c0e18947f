// Starting the browser. See open_browser.h.
#include "view/open_browser.h"

#include <cstdlib>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gyre {

namespace {

bool has_display() {
#ifdef __APPLE__
  return true;
#else
  const auto given = [](const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr && *value != 0;
  };
  return given("DISPLAY") || given("WAYLAND_DISPLAY");
#endif
}

#ifdef __APPLE__
constexpr const char* kOpener = "open";
#else
constexpr const char* kOpener = "xdg-open";
#endif

}  // namespace

bool open_browser(const std::string& address) {
  if (!has_display()) return false;
  // By way of a child that ends at once, so that the browser is nobody's to wait for. Its status tells nothing about the
  // opener, which it leaves behind; whether there is one is looked up before.
  const std::string look_up = std::string("command -v ") + kOpener + " >/dev/null 2>&1";
  if (std::system(look_up.c_str()) != 0) return false;
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    if (fork() == 0) {
      setsid();
      const int nowhere = open("/dev/null", O_RDWR);
      for (int i = 0; i < 3; ++i) dup2(nowhere, i);
      execlp(kOpener, kOpener, address.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  return true;
}

}  // namespace gyre
