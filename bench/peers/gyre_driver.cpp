// Gyre in the benchmark scenes, for comparison with the programs beside this one.
#include "bench/scenes/gyre_engine.h"

int main(int argc, char** argv) {
  auto* engine = new gyre::bench::GyreEngine();  // never destroyed: tear-down is not measured
  return gyre::bench::run_program(*engine, argc, argv);
}
