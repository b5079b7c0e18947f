// gyre-mpi simulate: one scene, its space divided among the ranks. docs/scaling.md explains the method and its limits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace gyre {

struct RankedOptions {
  std::string scene;
  std::optional<double> duration;      // s
  std::optional<std::uint64_t> steps;  // instead
  double halo = 2.0;  // width of the layer of followed bodies, in diameters of the largest ordinary body
  bool exchange_steps = false;   // exchange once a step instead of once a sub-step
  int rebalance = 30;            // steps between two divisions of space; 0: only at the start
  std::uint64_t checkpoint = 0;  // steps between two checkpoints; 0: none
  std::string checkpoint_file;   // a scene; empty: NAME.checkpoint.gyre.json beside the current folder
  std::string final_file;        // a scene of the last state
  bool json = false, quiet = false;
};

void add_ranked_options(CLI::App& command, RankedOptions& options);
// For all ranks at once; the exit status.
int simulate_ranked(const RankedOptions& options);

}  // namespace gyre
