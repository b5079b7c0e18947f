// Clocks and memory of this process.
#pragma once

#include <sys/resource.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <vector>

namespace gyre::bench {

inline double wall_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
// Of all threads of the process.
inline double cpu_ms() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}
// High-water mark of resident memory since the program started (getrusage would also count the parent's).
inline double peak_mb() {
  double kb = 0;
  char line[256];
  if (std::FILE* f = std::fopen("/proc/self/status", "r")) {
    while (std::fgets(line, sizeof line, f) != nullptr) {
      if (std::sscanf(line, "VmHWM: %lf", &kb) == 1) break;
    }
    std::fclose(f);
  }
  return kb / 1024.0;
}
inline long preemptions() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return u.ru_nivcsw;
}
inline double quantile(std::vector<double> v, double f) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  const double i = f * double(v.size() - 1);
  const auto k = std::size_t(i);
  return k + 1 < v.size() ? v[k] + (i - double(k)) * (v[k + 1] - v[k]) : v[k];
}

}  // namespace gyre::bench
