// gyre bench: runs the benchmark scenes (bench/scenes), prints how long steps took and how well the scenes were simulated.
#include "bench/scenes/clock.h"
#include "bench/scenes/gyre_engine.h"
#include "commands.h"
#include "exit_code.h"
#include "option_checks.h"
#include "progress.h"
#include "scene/json_writer.h"

#include <gyre/debug.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace gyre {
namespace {

struct BenchOptions {
  std::vector<std::string> scenes;
  int threads = 1;
  int steps = 0;
  int substeps = 4;
  int rounds = 1;
  bool sleeping = false;
  bool stages = false;
  bool json = false;
};

struct StageSum {
  std::string name;
  double ms = 0;  // mean a step
};

// One scene, some rounds: figures of the round with the median mean step.
struct BenchResult {
  std::string scene;
  std::size_t bodies = 0, joints = 0;
  bench::RunResult run;
  double spread_ms = 0;  // half of what lies between the fastest and the slowest round
  std::vector<StageSum> stages;
  double touching = 0, points = 0;  // mean a step, where stages are timed: pairs that touch, contact points
  std::string skipped;
};

// Adds up the stages' times behind the scenes' clock.
class TimedEngine final : public bench::Engine {
 public:
  TimedEngine(bench::GyreEngine& engine, std::vector<StageSum>& stages) : engine_(engine), stages_(stages) {}
  const char* name() const override { return engine_.name(); }
  std::string settings() const override { return engine_.settings(); }
  bool create(const bench::Scene& scene, int threads, bool sleep, std::string& why_not) override {
    if (!engine_.create(scene, threads, sleep, why_not)) return false;
    set_timing(engine_.world(), true);
    return true;
  }
  void step() override {
    engine_.step();
    read_times(engine_.world(), times_);
    stages_.resize(times_.stages.size());
    for (std::size_t i = 0; i < stages_.size(); ++i) {
      stages_[i].name = times_.stages[i].name;
      stages_[i].ms += 1e3 * times_.stages[i].seconds;
    }
    const WorldStats counts = engine_.world().stats();
    touching += counts.touching;
    points += counts.contact_points;
  }
  bench::BodyState state(int body) override { return engine_.state(body); }
  bool cast_ray(bench::V3 from, bench::V3 by, double& fraction) override {
    return engine_.cast_ray(from, by, fraction);
  }
  double touching = 0, points = 0;  // sums over the steps

 private:
  bench::GyreEngine& engine_;
  std::vector<StageSum>& stages_;
  StepTimes times_;
};

// Shows how many steps were made.
class WatchedEngine final : public bench::Engine {
 public:
  WatchedEngine(bench::Engine& engine, Progress& progress) : engine_(engine), progress_(progress) {}
  const char* name() const override { return engine_.name(); }
  std::string settings() const override { return engine_.settings(); }
  bool create(const bench::Scene& scene, int threads, bool sleep, std::string& why_not) override {
    return engine_.create(scene, threads, sleep, why_not);
  }
  void step() override {
    engine_.step();
    progress_.show(++steps_);  // on a terminal 10 lines a second, 0.1 ms of it
  }
  bench::BodyState state(int body) override { return engine_.state(body); }
  bool cast_ray(bench::V3 from, bench::V3 by, double& fraction) override {
    return engine_.cast_ray(from, by, fraction);
  }

 private:
  bench::Engine& engine_;
  Progress& progress_;
  std::uint64_t steps_ = 0;
};

BenchResult run_scene(const bench::Scene& scene, const BenchOptions& options) {
  BenchResult result;
  result.scene = scene.name;
  result.bodies = scene.bodies.size();
  result.joints = scene.joints.size();
  const int steps = options.steps > 0 ? options.steps : scene.steps;
  std::vector<std::pair<double, bench::RunResult>> rounds;
  for (int round = 0; round < options.rounds; ++round) {
    bench::GyreEngine engine(options.substeps);
    std::vector<StageSum> stages;
    TimedEngine timed(engine, stages);
    bench::Engine& measured = options.stages ? static_cast<bench::Engine&>(timed) : engine;
    Progress progress(true, std::uint64_t(steps), "steps");
    WatchedEngine watched(measured, progress);
    const double begin = bench::wall_ms();
    if (!measured.create(scene, options.threads, options.sleeping, result.skipped)) return result;
    const double create_ms = bench::wall_ms() - begin;
    rounds.emplace_back(0.0, bench::run(watched, scene, steps));
    progress.clear();
    rounds.back().second.create_ms = create_ms;
    rounds.back().first = rounds.back().second.mean_ms;
    for (StageSum& stage : stages) stage.ms /= double(rounds.back().second.steps);
    result.stages = stages;
    result.touching = timed.touching / double(rounds.back().second.steps);
    result.points = timed.points / double(rounds.back().second.steps);
  }
  if (rounds.empty()) return result;
  std::sort(rounds.begin(), rounds.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  result.run = rounds[rounds.size() / 2].second;
  result.spread_ms = 0.5 * (rounds.back().first - rounds.front().first);
  return result;
}

void print_head() {
  std::printf("%-16s %7s %6s  %9s %8s %9s %9s  %10s %9s %9s %9s\n", "scene", "bodies", "steps", "mean ms",
              "+-", "99 % ms", "worst ms", "overlap mm", "joint mm", "stretch %", "creep mm/s");
}

void print_row(const BenchResult& r) {
  if (!r.skipped.empty()) {
    std::printf("%-16s skipped: %s\n", r.scene.c_str(), r.skipped.c_str());
    return;
  }
  std::printf("%-16s %7zu %6d  %9.3f %8.3f %9.3f %9.3f  %10.2f %9.2f %9.3f %9.3f\n", r.scene.c_str(),
              r.bodies, r.run.steps, r.run.mean_ms, r.spread_ms, r.run.p99_ms, r.run.max_ms,
              1e3 * r.run.end.pen_p99, 1e3 * r.run.joint_peak, r.run.stretch_peak, 1e3 * r.run.creep_mean);
  for (const StageSum& stage : r.stages) {
    std::printf("  %-22s %9.4f ms  %5.1f %%\n", stage.name.c_str(), stage.ms, 100 * stage.ms / r.run.mean_ms);
  }
  if (!r.stages.empty()) {
    std::printf("  %-22s %9.0f pairs, %.0f points, mean of the steps\n", "touch", r.touching, r.points);
  }
}

void write_result(JsonWriter& out, const BenchResult& r) {
  const bench::Quality& q = r.run.end;
  out.begin_object();
  out.field("scene", r.scene);
  out.field("bodies", std::int64_t(r.bodies));
  out.field("joints", std::int64_t(r.joints));
  if (!r.skipped.empty()) {
    out.field("skipped", r.skipped);
    out.end_object();
    return;
  }
  out.field("steps", r.run.steps);
  out.key("step_ms").begin_object(JsonLayout::one_line);
  out.field("mean", float(r.run.mean_ms));
  out.field("spread", float(r.spread_ms));
  out.field("median", float(r.run.median_ms));
  out.field("p99", float(r.run.p99_ms));
  out.field("max", float(r.run.max_ms));
  out.field("cpu", float(r.run.cpu_ms_per_step));
  out.end_object();
  if (!r.stages.empty()) {
    out.key("stage_ms").begin_object(JsonLayout::one_line);
    for (const StageSum& stage : r.stages) out.field(stage.name, float(stage.ms));
    out.end_object();
    out.field("touching_pairs", float(r.touching));
    out.field("contact_points", float(r.points));
  }
  out.field("create_ms", float(r.run.create_ms));
  out.field("memory_mb", float(r.run.rss_mb));
  out.key("quality").begin_object(JsonLayout::one_line);
  out.field("penetration_p99", float(q.pen_p99));
  out.field("penetration_peak", float(r.run.pen_peak));
  out.field("drift_max", float(q.drift_max));
  out.field("sink_max", float(q.sink_max));
  out.field("joint_peak", float(r.run.joint_peak));
  out.field("limit_peak_degrees", float(r.run.limit_peak));
  out.field("stretch_peak_percent", float(r.run.stretch_peak));
  out.field("creep_mean", float(r.run.creep_mean));
  out.field("lost", std::int64_t(q.lost));
  out.end_object();
  out.end_object();
}

std::string json_text(const std::vector<BenchResult>& results, const BenchOptions& options) {
  JsonWriter out;
  out.begin_object();
  out.field("threads", options.threads);
  out.field("substeps", options.substeps);
  out.field("rounds", options.rounds);
  out.key("scenes").begin_array();
  for (const BenchResult& r : results) write_result(out, r);
  out.end_array();
  out.end_object();
  return out.take();
}

// The scenes by their names; those that are asked rays are for bench/peers.
bool choose_scenes(const BenchOptions& options, std::vector<bench::Scene>& scenes) {
  std::vector<std::string> names = options.scenes;
  if (names.empty()) names.assign(bench::scene_names().begin(), bench::scene_names().end());
  for (const std::string& name : names) {
    std::optional<bench::Scene> scene = bench::find_scene(name);
    if (!scene || (scene->rays && !options.scenes.empty())) {
      std::string all;
      for (const char* known : bench::scene_names()) all += std::string(" ") + known;
      std::fprintf(stderr,
                   "gyre bench: no scene '%s' to be stepped; there are:%s, and with N bodies (rows), to a "
                   "million: %s\n",
                   name.c_str(), all.c_str(), bench::numbered_scene_names().c_str());
      return false;
    }
    if (!scene->rays) scenes.push_back(*std::move(scene));
  }
  return true;
}

int run_bench(const BenchOptions& options) {
  std::vector<bench::Scene> scenes;
  if (!choose_scenes(options, scenes)) return kExitUsage;
  if (!options.json) print_head();
  std::vector<BenchResult> results;
  for (const bench::Scene& scene : scenes) {
    results.push_back(run_scene(scene, options));
    if (!options.json) print_row(results.back());
    std::fflush(stdout);
  }
  if (options.json) std::fputs(json_text(results, options).c_str(), stdout);
  for (const BenchResult& r : results) {
    if (!r.run.end.finite) return kExitNotFinite;
  }
  return kExitGood;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("bench", "Run the benchmark scenes: times, and figures of quality beside them");
  auto options = std::make_shared<BenchOptions>();
  command->add_option(
      "SCENE", options->scenes,
      "Their names; none: all. With N bodies (to a million), or rows: " + bench::numbered_scene_names());
  add_threads_option(*command, options->threads, "Threads, 0 = all")->capture_default_str();
  command->add_option("--steps", options->steps, "Steps of 1/60 s, 0 = as many as the scene has")
      ->check(CLI::Range(0, 1000000));
  command->add_option("--substeps", options->substeps, "Sub-steps a step")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--rounds", options->rounds, "Runs of each scene; the middle one counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--sleeping", options->sleeping,
                    "Let bodies sleep; otherwise all are simulated to the end");
  command->add_flag("--stages", options->stages, "Where the time goes, stage by stage (docs/step.md)");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([options, &exit_code] { exit_code = run_bench(*options); });
}

}  // namespace gyre
