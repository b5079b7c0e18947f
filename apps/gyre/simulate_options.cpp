// gyre simulate: its options, and what they change in a scene. See simulate.h.
#include "commands.h"
#include "exit_code.h"
#include "import_options.h"
#include "option_checks.h"
#include "simulate.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace gyre {
namespace {

std::vector<std::string> broad_phases() {
  std::vector<std::string> names;
  for (int i = 0; i < kBroadPhaseKindCount; ++i) names.emplace_back(to_string(BroadPhaseKind(i)));
  return names;
}

void add_time_options(CLI::App& command, SimulateOptions& options) {
  CLI::Option* duration = command
                              .add_option("--duration", options.duration,
                                          "Simulated time in s; 10 if --steps is not given either")
                              ->type_name("S")
                              ->check(number_between(0, false, 1e12, "a number from 0 to 1e12"));
  command.add_option("--steps", options.steps, "Number of steps, instead of a duration")
      ->type_name("N")
      ->check(number_between(0, false, 1e12, "an integer from 0 to 1e12"))
      ->excludes(duration);
  command.add_option("--step", options.time_step, "Length of a step in s")
      ->type_name("S")
      ->check(number_between(0, true, 1, "a number above 0 and at most 1"));
  command.add_option("--substeps", options.substeps, "Sub-steps in a step, 1 to 64")
      ->type_name("N")
      ->check(number_between(1, false, 64, "an integer from 1 to 64"));
  add_threads_option(command, options.threads,
                     "Worker threads, 0 for all of the machine; never changes a result");
}

void add_method_options(CLI::App& command, SimulateOptions& options) {
  take_one_of(command
                  .add_option("--solver", options.solver,
                              "Solver of contacts and joints: soft_step, sequential_impulses or lcp")
                  ->type_name("NAME"),
              {"soft_step", "sequential_impulses", "lcp"});
  take_one_of(command
                  .add_option("--integrator", options.integrator,
                              "Integrator: explicit_euler, semi_implicit_euler, rk4 or verlet")
                  ->type_name("NAME"),
              {"explicit_euler", "semi_implicit_euler", "rk4", "verlet"});
  take_one_of(
      command
          .add_option(
              "--broad-phase", options.broad_phase,
              "Broad phase: bvh, grid, octree, quadtree, kd_tree, bsp_tree, sweep_and_prune or brute_force; "
              "never changes a result")
          ->type_name("NAME"),
      broad_phases());
  take_one_of(command
                  .add_option("--stepping", options.stepping,
                              "Time plan: fixed, adaptive (to impacts) or error_controlled")
                  ->type_name("NAME"),
              {"fixed", "adaptive", "error_controlled"});
  command.add_option("--tolerance", options.tolerance, "Error of a step in m, if the time plan is not fixed")
      ->type_name("M")
      ->check(number_between(1e-9, false, 1, "a number from 1e-9 to 1"));
  take_one_of(command
                  .add_option("--springs", options.springs,
                              "Springs of distance joints: implicit, or explicit (forces to the integrator)")
                  ->type_name("NAME"),
              {"implicit", "explicit"});
  command.add_flag("--no-sleeping", options.no_sleeping, "Resting bodies stay awake");
}

void add_vtk_options(CLI::App& command, SimulateOptions& options) {
  CLI::Option* vtk = command
                         .add_option("--vtk", options.vtk,
                                     "Write surfaces and fields of the start and of every step for ParaView, "
                                     "which opens FOLDER/run.pvd")
                         ->type_name("FOLDER");
  command.add_option("--vtk-every", options.vtk_every, "VTK files of every Nth step only")
      ->type_name("N")
      ->check(number_between(1, false, 1e12, "an integer from 1 to 1e12"))
      ->needs(vtk);
}

void add_output_options(CLI::App& command, SimulateOptions& options) {
  CLI::Option* record = command
                            .add_option("--record", options.record,
                                        "Write a recording, to be looked at and replayed bit by bit")
                            ->type_name("FILE.gyrec");
  take_one_of(
      command
          .add_option("--record-as", options.record_as,
                      "What it holds: all; poses (only to be looked at); commands (only to be replayed)")
          ->type_name("WHAT"),
      {"all", "poses", "commands"})
      ->needs(record);
  command.add_option("--record-every", options.record_every, "Poses of every Nth step, and of the last")
      ->type_name("N")
      ->check(number_between(1, false, 1e9, "an integer from 1 to 1e9"))
      ->needs(record);
  command
      .add_option("--record-accuracy", options.record_accuracy,
                  "By how much a position may be off in m; 0.0001 if not given. Replays are always exact")
      ->type_name("M")
      ->check(number_between(1e-12, false, 1e5, "a number from 1e-12 to 1e5"))
      ->needs(record);
  command
      .add_option("--record-hash-every", options.record_hash_every,
                  "A hash of the whole state after every Nth step, 128 if not given, and the last; one of "
                  "what moves after the others")
      ->type_name("N")
      ->check(number_between(1, false, 1e9, "an integer from 1 to 1e9"))
      ->needs(record);
  CLI::Option* trace =
      command
          .add_option("--trace", options.trace,
                      "Write a table of the motion of every body and every vertex of soft matter")
          ->type_name("FILE.csv");
  command
      .add_option("--trace-only", options.trace_only,
                  "In --trace, only this body, rope, cloth or solid; may be repeated")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->needs(trace);
  command.add_option("--joints", options.joints, "Write a table of the forces and torques of every joint")
      ->type_name("FILE.csv");
  command.add_option("--contacts", options.contacts, "Write a table of every contact point and its forces")
      ->type_name("FILE.csv");
  command.add_flag("--trace-liquids", options.trace_liquids, "In --trace, the particles of liquids too")
      ->needs(trace);
  command.add_option("--probes", options.probes, "Write a table of gases and liquids at the scene's probes")
      ->type_name("FILE.csv");
  command
      .add_option("--events", options.events,
                  "Write a table of what happened: touches, sensors, sleep, fluids")
      ->type_name("FILE.csv");
  command
      .add_option("--trace-every", options.trace_every,
                  "Rows of --trace, --joints, --contacts and --probes only every Nth step")
      ->type_name("N")
      ->check(number_between(1, false, 1e12, "an integer from 1 to 1e12"));
  add_vtk_options(command, options);
  CLI::Option* stats = command.add_option("--stats", options.stats, "Write a table of figures of each step")
                           ->type_name("FILE.csv");
  command
      .add_flag("--count-crossings", options.count_crossings,
                "In --stats, count where cloths pass through themselves and each other; exact, and slow")
      ->needs(stats);
  command.add_option("--final", options.final, "Write the final state as a scene")->type_name("FILE.json");
  command
      .add_option("--explain", options.explain,
                  "Say why this body is awake or asleep at the end; may be repeated")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_flag("--times", options.times, "Say which stages of a step take how long");
  command.add_flag("--hash", options.hash, "Print a hash of the final state, the same on every machine");
  command.add_flag("--json", options.json, "Print the summary as JSON");
  command.add_flag("--quiet", options.quiet, "Print no summary and show no progress");
}

}  // namespace

void add_simulate(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("simulate", "Run a scene. An output file - is standard output");
  const auto options = std::make_shared<SimulateOptions>();
  command
      ->add_option("SCENE", options->scene,
                   "The scene file (*.gyre.json), or a robot or glTF file; - for standard input")
      ->required()
      ->type_name("");
  add_time_options(*command, *options);
  add_method_options(*command, *options);
  add_output_options(*command, *options);
  add_import_options(*command, options->import);
  command->callback([options, &exit_code] { exit_code = simulate(*options); });
}

std::string apply_overrides(const SimulateOptions& options, SceneWorld& world) {
  for (int i = 0; i < kSolverKindCount; ++i) {
    if (options.solver == to_string(SolverKind(i))) world.solver = SolverKind(i);
  }
  for (int i = 0; i < kIntegratorKindCount; ++i) {
    if (options.integrator == to_string(IntegratorKind(i))) world.integrator = IntegratorKind(i);
  }
  for (int i = 0; i < kTimeSteppingCount; ++i) {
    if (options.stepping == to_string(TimeStepping(i))) world.stepping = TimeStepping(i);
  }
  for (const SpringKind springs : {SpringKind::implicit, SpringKind::explicit_force}) {
    if (options.springs == to_string(springs)) world.springs = springs;
  }
  if (options.tolerance) world.tolerance = *options.tolerance;
  for (int i = 0; i < kBroadPhaseKindCount; ++i) {
    if (options.broad_phase == to_string(BroadPhaseKind(i))) world.broad_phase = BroadPhaseKind(i);
  }
  if (options.time_step) world.time_step = *options.time_step;
  if (options.substeps) world.substeps = *options.substeps;
  if (options.no_sleeping) world.sleeping = false;
  if (float(world.time_step) == 0.0f) return "--step is too small, expected at least 1e-45";
  return {};
}

std::uint64_t step_count(const SimulateOptions& options, double time_step) {
  if (options.steps) return *options.steps;
  // Enough steps to reach the duration; a time step that was rounded to a few digits must not cost one more.
  const double steps = options.duration.value_or(10.0) / time_step;
  return std::uint64_t(std::ceil(steps - 1.0e-6 * max(steps, 1.0e-3)));
}

}  // namespace gyre
