// gyre-mpi simulate. See mpi_simulate.h.
#include "mpi/mpi_simulate.h"

#include "exit_code.h"
#include "interrupt.h"
#include "mpi/ranked_world.h"
#include "output_file.h"
#include "progress.h"
#include "scene/json_writer.h"
#include "scene/number_text.h"
#include "scene/scene_reader.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

namespace gyre {
namespace {

SceneRunner open_runner(const std::string& path) {
  SceneResult<Scene> scene = load_scene(path);
  if (!scene) throw std::runtime_error(scene.error().text());
  const std::string obstacle = RankedWorld::find_obstacle(*scene);
  if (!obstacle.empty())
    throw std::runtime_error(path + ": has " + obstacle +
                             ", which cannot be divided among ranks; gyre simulate runs it");
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), path);
  if (!runner) throw std::runtime_error(runner.error().text());
  return *std::move(runner);
}

std::string checkpoint_of(const RankedOptions& options) {
  if (!options.checkpoint_file.empty()) return options.checkpoint_file;
  std::string name = std::filesystem::path(options.scene).filename().string();
  for (const char* end : {".gyre.json", ".json"}) {
    const std::string_view tail(end);
    if (name.size() > tail.size() && name.compare(name.size() - tail.size(), tail.size(), tail) == 0)
      name.resize(name.size() - tail.size());
  }
  return name + ".checkpoint.gyre.json";
}

// A scene appears whole or not at all, so the last one stays if a rank dies meanwhile.
void write_gathered(RankedWorld& world, const std::string& path, int rank) {
  const std::string text = world.gather_scene();
  if (rank != 0) return;
  OutputFile file;
  if (!file.open(path) || !file.write(text) || !file.commit()) throw std::runtime_error(file.message());
}

struct Totals {
  double wall = 0, cpu = 0, busiest = 0, bytes = 0, messages = 0, followed = 0, migrations = 0;
};

void print_result(const RankedOptions& options, const RankedWorld& world, const RankedWorld::Quality& quality,
                  const Totals& totals, int ranks) {
  const double steps = std::max(1.0, double(world.steps()));
  JsonWriter json;
  json.begin_object();
  json.field("ranks", ranks);
  json.field("bodies", quality.bodies);
  json.field("steps", std::int64_t(world.steps()));
  json.field("seconds", totals.wall);
  json.field("cpu_seconds", totals.cpu);
  json.field("busiest_rank_cpu_seconds", totals.busiest);
  json.field("imbalance", totals.cpu > 0 ? totals.busiest * ranks / totals.cpu : 1.0);
  json.field("bytes_a_step", totals.bytes / steps);
  json.field("messages_a_step", totals.messages / steps);
  json.field("followed", totals.followed / steps);
  json.field("migrations_a_step", totals.migrations / steps);
  json.field("awake", quality.awake);
  json.field("center_of_mass", quality.center);
  json.field("momentum", quality.momentum);
  json.field("kinetic_energy", quality.kinetic);
  json.field("deepest_overlap", quality.deepest_overlap);
  json.end_object();
  const std::string text = json.take();
  if (options.json) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return;
  }
  std::printf("%d ranks, %.0f bodies, %llu steps in %s s; busiest rank %s s of CPU, imbalance %s\n", ranks,
              quality.bodies, static_cast<unsigned long long>(world.steps()), rounded(totals.wall, 3).c_str(),
              rounded(totals.busiest, 3).c_str(),
              rounded(totals.cpu > 0 ? totals.busiest * ranks / totals.cpu : 1.0, 3).c_str());
  std::printf("a step: %s bytes in %s messages, %s units followed, %s migrate\n",
              rounded(totals.bytes / steps, 4).c_str(), rounded(totals.messages / steps, 3).c_str(),
              rounded(totals.followed / steps, 4).c_str(), rounded(totals.migrations / steps, 3).c_str());
  std::printf("end: %.0f bodies awake, kinetic energy %s J, deepest overlap %s mm\n", quality.awake,
              rounded(quality.kinetic, 4).c_str(), rounded(1e3 * quality.deepest_overlap, 3).c_str());
}

bool run_steps(const RankedOptions& options, RankedWorld& world, const Transport& transport,
               std::uint64_t steps) {
  Progress progress(!options.quiet && transport.rank() == 0, steps);
  for (std::uint64_t i = 0; i < steps; ++i) {
    if (i > 0 && options.rebalance > 0 && i % std::uint64_t(options.rebalance) == 0) world.rebalance();
    world.step();
    progress.show(i + 1);
    if (options.checkpoint > 0 && (i + 1) % options.checkpoint == 0)
      write_gathered(world, checkpoint_of(options), transport.rank());
    // All ranks end in the same step.
    if (i % 16 == 15 && transport.max(interrupted() ? 1 : 0) > 0) return false;
  }
  return true;
}

}  // namespace

void add_ranked_options(CLI::App& command, RankedOptions& options) {
  command.add_option("SCENE", options.scene, "The scene file (*.gyre.json), which every rank reads")
      ->required()
      ->type_name("");
  CLI::Option* duration = command
                              .add_option("--duration", options.duration,
                                          "Simulated time in s; 10 if --steps is not given either")
                              ->type_name("S")
                              ->check(CLI::Range(0.0, 1e12));
  command.add_option("--steps", options.steps, "Number of steps, instead of a duration")
      ->type_name("N")
      ->excludes(duration);
  command
      .add_option(
          "--halo", options.halo,
          "Width of the layer of bodies beyond its border that a rank follows, in diameters; 2 if not given")
      ->type_name("D")
      ->check(CLI::Range(0.5, 100.0));
  command.add_flag("--exchange-steps", options.exchange_steps,
                   "Exchange motion once a step instead of once a sub-step: fewer messages, larger errors");
  command
      .add_option("--rebalance", options.rebalance,
                  "Steps between two divisions of space, 0 for only one at the start; 30 if not given")
      ->type_name("N")
      ->check(CLI::Range(0, 1000000000));
  command
      .add_option("--checkpoint", options.checkpoint,
                  "Write the state as a scene every N steps, from which any number of ranks can go on")
      ->type_name("N");
  command
      .add_option("--checkpoint-file", options.checkpoint_file,
                  "Where; NAME.checkpoint.gyre.json if not given")
      ->type_name("FILE.json");
  command.add_option("--final", options.final_file, "Write the final state as a scene")
      ->type_name("FILE.json");
  command.add_flag("--json", options.json, "Print the figures as JSON");
  command.add_flag("--quiet", options.quiet, "Print no summary and show no progress");
}

int simulate_ranked(const RankedOptions& options) {
  Transport transport;
  watch_interrupt();
  const auto begin = std::chrono::steady_clock::now();
  std::string problem;
  std::optional<SceneRunner> whole, own;
  try {
    whole = open_runner(options.scene);
    own = open_runner(options.scene);
  } catch (const std::runtime_error& error) {
    problem = error.what();
  }
  if (transport.max(problem.empty() ? 0 : 1) > 0) {
    if (transport.rank() == 0)
      std::fprintf(stderr, "gyre-mpi: %s\n",
                   problem.empty() ? "a rank could not read the scene" : problem.c_str());
    return kExitInvalid;
  }
  const double time_step = whole->scene().world.time_step;
  const double wanted = options.duration.value_or(10.0) / time_step;
  const std::uint64_t steps =
      options.steps ? *options.steps : std::uint64_t(std::ceil(wanted - 1e-6 * std::max(wanted, 1e-3)));
  RankedWorld world(transport, *std::move(whole), *std::move(own), options.halo, options.exchange_steps);
  const bool whole_run = run_steps(options, world, transport, steps);
  Totals totals;
  totals.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const RankedFigures& figures = world.figures();
  totals.cpu = transport.sum(figures.cpu_seconds);
  totals.busiest = transport.max(figures.cpu_seconds);
  totals.bytes = transport.sum(double(transport.bytes_sent()));
  totals.messages = transport.sum(double(transport.messages_sent()));
  totals.followed = transport.sum(double(figures.followed));
  totals.migrations = transport.sum(double(figures.migrations));
  const RankedWorld::Quality quality = world.quality();
  if (!options.final_file.empty()) write_gathered(world, options.final_file, transport.rank());
  if (transport.rank() == 0 && (options.json || !options.quiet))
    print_result(options, world, quality, totals, transport.size());
  return whole_run ? kExitGood : kExitInterrupted;
}

}  // namespace gyre
