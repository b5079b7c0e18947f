// A progress bar on stderr. See progress.h.
#include "progress.h"

#include <cstdio>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace gyre {
namespace {

bool stderr_is_terminal() {
#ifdef _WIN32
  return _isatty(2) != 0;
#else
  return isatty(2) != 0;
#endif
}

}  // namespace

Progress::Progress(bool wanted, std::uint64_t steps, const char* unit)
    : active_(wanted && steps > 0 && stderr_is_terminal()), steps_(steps), unit_(unit) {
  // A run that is over at once needs no bar.
  next_ = start_ + std::chrono::milliseconds(300);
}

void Progress::show(std::uint64_t done) {
  if (!active_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  constexpr int kWidth = 30;
  const double share = double(done) / double(steps_);
  const double passed = std::chrono::duration<double>(now - start_).count();
  char bar[kWidth + 1];
  for (int i = 0; i < kWidth; ++i) bar[i] = double(i) < share * kWidth ? '#' : '.';
  bar[kWidth] = 0;
  std::fprintf(stderr, "\r[%s] %3d %%  %llu of %llu %s, %.0f s left   ", bar, int(100.0 * share),
               static_cast<unsigned long long>(done), static_cast<unsigned long long>(steps_), unit_,
               done > 0 ? passed * (1.0 - share) / share : 0.0);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (drawn_) std::fprintf(stderr, "\r%80s\r", "");
  drawn_ = false;
}

}  // namespace gyre
