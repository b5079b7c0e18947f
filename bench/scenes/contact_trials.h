// Trials of contacts within a step, with exact answers: near misses, blows off the centre, small bounces, tiles, and supports that
// turn. Every trial is one scene of many lanes with drawn sizes, speeds and phases, for the driver of any engine.
//
//   PROGRAM trial NAME
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/scenes/engine.h"

namespace gyre::bench {

// A dynamic body over the run.
struct BodyTrace {
  int body = 0;
  double highest = 0;  // m: the largest y of its centre
  BodyState last;
};

struct Figure {
  const char* name;  // with its unit
  double value;
};

struct ContactTrial {
  const char* name;
  int steps;
  Scene (*make)();
  // `first`: the states of all bodies as the run begins; `last`: as it ends.
  std::vector<Figure> (*judge)(const Scene&, const std::vector<BodyTrace>&,
                               const std::vector<BodyState>& first, const std::vector<BodyState>& last);
};

const std::vector<ContactTrial>& contact_trials();
// Runs a trial in an engine that has no scene yet; nothing if the engine cannot.
std::optional<std::vector<Figure>> find_figures(Engine& engine, const ContactTrial& trial);
// The same, printed as one line of JSON. Returns the exit status of a program: 1 if the engine cannot, 2 if there is no such trial.
int run_trial(Engine& engine, const std::string& name);

}  // namespace gyre::bench
