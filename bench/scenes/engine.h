// What a driver says of its engine, and the program that runs one scene in it: times it, judges it, and prints one line of JSON.
//
//   PROGRAM SCENE THREADS STEPS [sleep] [end]     STEPS 0: as many as the scene has; end: judged only as it ends
#pragma once

#include <string>
#include <vector>

#include "bench/scenes/judge.h"
#include "bench/scenes/scene.h"

namespace gyre::bench {

class Engine {
 public:
  virtual ~Engine() = default;
  virtual const char* name() const = 0;
  virtual std::string settings() const = 0;  // what was chosen: iterations, sub-steps, broad phase
  // Builds the scene, once; `scene` outlives the engine. False with a reason if the engine cannot.
  virtual bool create(const Scene& scene, int threads, bool sleep, std::string& why_not) = 0;
  virtual void step() = 0;  // of 1/60 s
  virtual BodyState state(int body) = 0;
  // The nearest hit along from + f * by, 0 <= f <= 1.
  virtual bool cast_ray(V3 from, V3 by, double& fraction) = 0;
};

struct RunOptions {
  std::string scene;
  int threads = 1;
  int steps = 0;  // 0: as many as the scene has
  bool sleep = false;
  bool end_only = false;  // judged as the run ends alone: memory and the slowest steps are the engine's own
};

// Figures of one run, in ms and in the units of Quality.
struct RunResult {
  int steps = 0;
  double median_ms = 0, mean_ms = 0, p99_ms = 0, max_ms = 0, first_ms = 0, last_quarter_ms = 0;
  double cpu_ms_per_step = 0, wall_ms = 0, create_ms = 0, rss_mb = 0;
  // Processor time of the steps after the first half of the run, when contacts exist: other programs lengthen them least.
  double settled_median_ms = 0, settled_p99_ms = 0, settled_max_ms = 0;
  long preempted = 0;
  Quality end;  // as the run ended
  double pen_peak = 0, speed_peak = 0, joint_peak = 0, limit_peak = 0,
         stretch_peak = 0;  // of eight looks over the run
  // Unrest read off positions, since engines differ in what their velocity means after a step: mean m/s of all moving bodies
  // over the last half second and over the last step.
  double creep_mean = 0, move_mean = 0;
};

// `engine` has created `scene`. Judged `looks` times, evenly over the run and as it ends.
RunResult run(Engine& engine, const Scene& scene, int steps, int looks = 8);

struct RayResult {
  std::size_t rays = 0;
  double rays_per_second = 0;
  long hits = 0;
  double fraction_sum = 0;
};
RayResult run_rays(Engine& engine, int rounds);

int run_program(Engine& engine, int argc, char** argv);

}  // namespace gyre::bench
