// The cases of a study over the ranks of MPI: rank 0 hands out numbers and takes lines; each rank, rank 0 too, runs a case at a time.
#pragma once

#include "sweep/sweep.h"

namespace gyre {

// For rank 0.
class RankedCases : public CaseRunner {
 public:
  void run(const Study& study, CaseQueue& queue) override;
  bool has_run() const { return has_run_; }

 private:
  bool has_run_ = false;
};

// For every other rank: runs what rank 0 hands out until there is no more.
void serve_cases(const SweepOptions& options);
// Lets waiting ranks go where rank 0 has nothing to hand out.
void release_ranks();

}  // namespace gyre
