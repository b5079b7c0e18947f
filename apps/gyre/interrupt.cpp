// Ctrl-C. See interrupt.h.
#include "interrupt.h"

#include <csignal>

namespace gyre {
namespace {

volatile std::sig_atomic_t was_interrupted = 0;

extern "C" void on_interrupt(int signal) {
  was_interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_interrupt() { std::signal(SIGINT, on_interrupt); }
bool interrupted() { return was_interrupted != 0; }

}  // namespace gyre
