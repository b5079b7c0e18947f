// The handler of failed checks: one for the process, which prints and aborts unless replaced.
#include "base/check.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace gyre {

namespace {

void print_and_abort(const char* condition, const char* words, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: %s (%s)\n", file, line, words, condition);
  std::fflush(stderr);
  std::abort();
}

std::atomic<CheckHandler> current_handler{print_and_abort};

}  // namespace

void set_check_handler(CheckHandler handler) {
  current_handler.store(handler != nullptr ? handler : print_and_abort, std::memory_order_release);
}

void check_failed(const char* condition, const char* words, const char* file, int line) {
  current_handler.load(std::memory_order_acquire)(condition, words, file, line);
}

}  // namespace gyre
