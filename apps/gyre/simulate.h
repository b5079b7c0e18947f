// gyre simulate: its options, and one run of it.
#pragma once

#include "formats/import.h"
#include "output_file.h"
#include "scene/scene.h"
#include "scene/scene_runner.h"
#include "tables.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gyre {

struct SimulateOptions {
  std::string scene;
  std::optional<double> duration;  // s
  std::optional<std::uint64_t> steps;
  std::optional<double> time_step;
  std::optional<int> substeps;
  std::optional<float> tolerance;  // m
  int threads = 1;
  std::string solver, integrator, broad_phase, stepping, springs;  // empty: what the scene says
  bool no_sleeping = false;
  std::string record, trace, joints, contacts, probes, events, stats, final;  // paths; empty: not written
  std::string record_as = "all";                                      // or poses, commands
  std::uint32_t record_every = 1;
  float record_accuracy = 1.0e-4f;  // m
  std::uint32_t record_hash_every = 128;
  std::uint64_t trace_every = 1;
  std::string vtk;  // a folder
  std::uint64_t vtk_every = 1;
  std::vector<std::string> explain;     // names of bodies
  std::vector<std::string> trace_only;  // names of bodies, soft matter and liquids; empty: all
  bool trace_liquids = false;
  bool count_crossings = false;  // of cloths, in the table of figures
  ImportOptions import;
  bool times = false, hash = false, json = false, quiet = false;
};

// What the options say instead of the scene. Returns the reason if this version does not have it.
std::string apply_overrides(const SimulateOptions& options, SceneWorld& world);

// How many steps make the wanted duration.
std::uint64_t step_count(const SimulateOptions& options, double time_step);

// Runs the scene as the options say; the exit status.
int simulate(const SimulateOptions& options);

}  // namespace gyre
