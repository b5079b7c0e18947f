// gyre sweep: runs the cases of a study, over threads here and over ranks in gyre-mpi.
#pragma once

#include "sweep/study.h"
#include "sweep/sweep_results.h"

#include <optional>

namespace CLI {
class App;
}

namespace gyre {

struct SweepOptions {
  std::string study;
  std::string output;                 // of JSON lines; empty: beside the study, NAME.results.jsonl
  std::optional<std::uint64_t> only;  // --case: this case alone, printed to stdout
  int threads = 0;                    // 0: as many as the machine has
  bool count = false;                 // print the number of cases
  bool quiet = false;
};

// The cases that are left. Any thread may take one and bring its line.
class CaseQueue {
 public:
  virtual ~CaseQueue() = default;
  // A case to run; none when there is no more, or on Ctrl-C.
  virtual std::optional<std::uint64_t> next() = 0;
  virtual void done(std::uint64_t number, const std::string& line) = 0;
};

// Takes cases from the queue and runs them until there is no more.
class CaseRunner {
 public:
  virtual ~CaseRunner() = default;
  virtual void run(const Study& study, CaseQueue& queue) = 0;
};

// `threads` threads of this process, each with a case of its own.
class ThreadedCases : public CaseRunner {
 public:
  explicit ThreadedCases(int threads) : threads_(threads) {}
  void run(const Study& study, CaseQueue& queue) override;

 private:
  int threads_;
};

// The exit status. Failed cases are counted on stderr and make it kExitFailed.
int sweep(const SweepOptions& options, CaseRunner& runner);

// The options of the command that gyre and gyre-mpi share.
void add_sweep_options(CLI::App& command, SweepOptions& options);
}  // namespace gyre
