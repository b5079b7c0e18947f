// A progress bar on stderr, and only when that is a terminal.
#pragma once

#include <chrono>
#include <cstdint>

namespace gyre {

class Progress {
 public:
  Progress(bool wanted, std::uint64_t steps, const char* unit = "steps");
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::uint64_t done);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool active_;
  bool drawn_ = false;
  std::uint64_t steps_;
  const char* unit_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
};

}  // namespace gyre
