// Waiting without sleep: a worker pauses first and later yields its core, so that more workers than cores still make
// progress.
#pragma once

// Defined as 1 if the platform has threads.
#if (defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)) || \
    (defined(__wasi__) && !defined(_REENTRANT))
#define GYRE_HAS_THREADS 0
#else
#define GYRE_HAS_THREADS 1
#include <thread>
#endif

#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace gyre {

// Tells the core that this is a waiting loop.
inline void cpu_pause() {
#if defined(_MSC_VER) && (defined(_M_X64) || defined(_M_IX86))
  _mm_pause();
#elif defined(_MSC_VER) && defined(_M_ARM64)
  __yield();
#elif defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ __volatile__("yield");
#endif
}

// Waits in a loop: call pause() in each iteration. After `patience` pauses the awaited worker has probably lost its
// core, so each further call yields this core.
class Spin {
 public:
  explicit Spin(int patience) : patience_(patience) {}

  void pause() {
    if (patience_ > 0) {
      --patience_;
      cpu_pause();
      return;
    }
#if GYRE_HAS_THREADS
    std::this_thread::yield();
#endif
  }
  bool patient() const { return patience_ > 0; }

 private:
  int patience_;
};

}  // namespace gyre
