#include "bench/scenes/engine.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "bench/scenes/clock.h"
#include "bench/scenes/contact_trials.h"

namespace gyre::bench {
namespace {

constexpr int kHalfSecond = 30;  // steps

std::vector<BodyState> states(Engine& engine, const Scene& scene) {
  std::vector<BodyState> out;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) out.push_back(engine.state(int(i)));
  return out;
}

double mean_way(const Scene& scene, const std::vector<BodyState>& from, const std::vector<BodyState>& to) {
  double sum = 0;
  long moving = 0;
  for (std::size_t i = 0; i < from.size() && i < to.size(); ++i) {
    if (scene.bodies[i].motion != Motion::dynamic) continue;
    sum += len(to[i].pose.p - from[i].pose.p);
    ++moving;
  }
  return moving > 0 ? sum / double(moving) : 0;
}

void look(const Judge& judge, const std::vector<BodyState>& bodies, RunResult& r) {
  r.end = judge.look(bodies);
  r.pen_peak = std::max(r.pen_peak, r.end.pen_max);
  r.stretch_peak = std::max(r.stretch_peak, r.end.stretch);
  r.joint_peak = std::max(r.joint_peak, r.end.joint_max);
  r.speed_peak = std::max(r.speed_peak, r.end.speed_max);
  r.limit_peak = std::max(r.limit_peak, r.end.limit_max);
}

void print(const char* engine, const RunOptions& options, const std::string& settings, const Scene& scene,
           const RunResult& r) {
  const Quality& q = r.end;
  std::printf("{\"engine\":\"%s\",\"scene\":\"%s\",\"threads\":%d,\"sleep\":%d,\"settings\":\"%s\",", engine,
              options.scene.c_str(), options.threads, int(options.sleep), settings.c_str());
  std::printf("\"bodies\":%zu,\"joints\":%zu,\"steps\":%d,", scene.bodies.size(), scene.joints.size(),
              r.steps);
  std::printf("\"median_ms\":%.4f,\"mean_ms\":%.4f,\"p99_ms\":%.4f,\"max_ms\":%.4f,\"first_ms\":%.4f,",
              r.median_ms, r.mean_ms, r.p99_ms, r.max_ms, r.first_ms);
  std::printf("\"last_quarter_ms\":%.4f,\"cpu_ms_per_step\":%.4f,\"wall_ms\":%.1f,\"preempted\":%ld,",
              r.last_quarter_ms, r.cpu_ms_per_step, r.wall_ms, r.preempted);
  std::printf("\"settled_median_ms\":%.4f,\"settled_p99_ms\":%.4f,\"settled_max_ms\":%.4f,",
              r.settled_median_ms, r.settled_p99_ms, r.settled_max_ms);
  std::printf("\"create_ms\":%.1f,\"rss_mb\":%.1f,\"finite\":%d,\"lost\":%ld,\"asleep\":%ld,\"fallen\":%ld,",
              r.create_ms, r.rss_mb, int(q.finite), q.lost, q.asleep, q.fallen);
  std::printf("\"pairs_near\":%ld,\"pairs_touching\":%ld,\"pairs_deep\":%ld,", q.near, q.touching, q.deep);
  std::printf("\"pen_max\":%.5f,\"pen_p99\":%.5f,\"pen_mean\":%.5f,\"pen_peak\":%.5f,", q.pen_max, q.pen_p99,
              q.pen_mean, r.pen_peak);
  std::printf("\"speed_max\":%.4f,\"speed_mean\":%.5f,\"spin_max\":%.4f,\"speed_peak\":%.3f,", q.speed_max,
              q.speed_mean, q.spin_max, r.speed_peak);
  std::printf("\"creep_mean\":%.6f,\"move_mean\":%.6f,\"energy\":%.4g,\"height_mean\":%.4f,", r.creep_mean,
              r.move_mean, q.energy, q.height_mean);
  std::printf("\"drift_max\":%.5f,\"drift_mean\":%.5f,\"sink_max\":%.5f,", q.drift_max, q.drift_mean,
              q.sink_max);
  std::printf("\"joint_max\":%.5f,\"joint_mean\":%.6f,\"joint_peak\":%.5f,", q.joint_max, q.joint_mean,
              r.joint_peak);
  std::printf("\"limit_max_deg\":%.3f,\"limit_mean_deg\":%.3f,\"limit_peak_deg\":%.3f,", q.limit_max,
              q.limit_mean, r.limit_peak);
  std::printf("\"stretch_pct\":%.4f,\"stretch_peak_pct\":%.4f,\"extension_pct\":%.4f}\n", q.stretch,
              r.stretch_peak, q.extension);
}

bool parse(int argc, char** argv, RunOptions& options) {
  if (argc < 4) {
    std::fprintf(
        stderr,
        "usage: %s SCENE THREADS STEPS [sleep] [end]\n  STEPS 0: as many as the scene has. Scenes:", argv[0]);
    for (const char* name : scene_names()) std::fprintf(stderr, " %s", name);
    std::fprintf(stderr,
                 "\n  box_pile and mesh_rain also with a number of bodies, as in box_pile:10000; field only "
                 "so.\n  trial NAME: a trial of contacts.\n");
    return false;
  }
  options.scene = argv[1];
  options.threads = std::atoi(argv[2]);
  options.steps = std::atoi(argv[3]);
  for (int i = 4; i < argc; ++i) {
    options.sleep = options.sleep || std::strcmp(argv[i], "sleep") == 0;
    options.end_only = options.end_only || std::strcmp(argv[i], "end") == 0;
  }
  return true;
}

}  // namespace

RunResult run(Engine& engine, const Scene& scene, int steps, int looks) {
  const Judge judge(scene);
  RunResult r;
  std::vector<double> ms, cpu_of_step;
  std::vector<BodyState> half_second_ago, last_step, now;
  const double before = peak_mb();
  double cpu = 0;
  for (int k = 0; k < steps; ++k) {
    const bool is_look = k == steps - 1 || (k + 1) % std::max(1, steps / looks) == 0;
    // What is copied and judged below is no memory of the engine's.
    if (r.rss_mb == 0 && (is_look || k == steps - kHalfSecond)) r.rss_mb = peak_mb() - before;
    if (k == steps - kHalfSecond) half_second_ago = states(engine, scene);
    if (k == steps - 1) last_step = states(engine, scene);
    const long preempted = preemptions();
    const double cpu_begin = cpu_ms(), begin = wall_ms();
    engine.step();
    ms.push_back(wall_ms() - begin);
    cpu_of_step.push_back(cpu_ms() - cpu_begin);
    cpu += cpu_of_step.back();
    r.preempted += preemptions() - preempted;
    r.wall_ms += ms.back();
    if (!is_look) continue;
    now = states(engine, scene);
    look(judge, now, r);
    if (!r.end.finite) break;
  }
  r.steps = int(ms.size());
  if (r.end.finite && !now.empty()) {
    r.creep_mean = mean_way(scene, half_second_ago, now) / (kHalfSecond * kDt);
    r.move_mean = mean_way(scene, last_step, now) / kDt;
  }
  r.median_ms = quantile(ms, 0.5);
  r.mean_ms = r.wall_ms / double(ms.size());
  r.p99_ms = quantile(ms, 0.99);
  r.max_ms = quantile(ms, 1.0);
  r.first_ms = ms.front();
  r.last_quarter_ms = quantile({ms.end() - std::ptrdiff_t(ms.size() / 4), ms.end()}, 0.5);
  r.cpu_ms_per_step = cpu / double(ms.size());
  cpu_of_step.erase(cpu_of_step.begin(), cpu_of_step.begin() + std::ptrdiff_t(ms.size() / 2));
  r.settled_median_ms = quantile(cpu_of_step, 0.5);
  r.settled_p99_ms = quantile(cpu_of_step, 0.99);
  r.settled_max_ms = quantile(cpu_of_step, 1.0);
  return r;
}

RayResult run_rays(Engine& engine, int rounds) {
  const std::vector<Ray> rays = ray_list();
  engine.step();  // lets engines build what they build lazily
  RayResult r;
  r.rays = rays.size();
  std::vector<double> rates;
  for (int k = 0; k < rounds; ++k) {
    r.hits = 0;
    r.fraction_sum = 0;
    const double begin = wall_ms();
    for (const Ray& ray : rays) {
      double fraction = 1;
      if (!engine.cast_ray(ray.from, ray.by, fraction)) continue;
      ++r.hits;
      r.fraction_sum += fraction;
    }
    rates.push_back(double(rays.size()) / (1e-3 * (wall_ms() - begin)));
  }
  r.rays_per_second = quantile(rates, 0.5);
  return r;
}

int run_program(Engine& engine, int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "trial") == 0) return run_trial(engine, argv[2]);
  RunOptions options;
  if (!parse(argc, argv, options)) return 2;
  const std::optional<Scene> scene = find_scene(options.scene);
  if (!scene) {
    std::fprintf(stderr, "no scene %s\n", options.scene.c_str());
    return 2;
  }
  const double memory = peak_mb(), begin = wall_ms();
  std::string why_not;
  if (!engine.create(*scene, options.threads, options.sleep, why_not)) {
    std::printf("{\"engine\":\"%s\",\"scene\":\"%s\",\"threads\":%d,\"skipped\":\"%s\"}\n", engine.name(),
                options.scene.c_str(), options.threads, why_not.c_str());
    return 0;
  }
  const double create_ms = wall_ms() - begin, created_mb = peak_mb() - memory;
  const int steps = options.steps > 0 ? options.steps : scene->steps;
  if (scene->rays) {
    const RayResult r = run_rays(engine, steps);
    std::printf(
        "{\"engine\":\"%s\",\"scene\":\"%s\",\"threads\":1,\"settings\":\"%s\",\"bodies\":%zu,\"rays\":%zu,"
        "\"rays_per_s\":%.0f,\"hits\":%ld,\"fraction_sum\":%.3f,\"create_ms\":%.1f,\"rss_mb\":%.1f}\n",
        engine.name(), options.scene.c_str(), engine.settings().c_str(), scene->bodies.size(), r.rays,
        r.rays_per_second, r.hits, r.fraction_sum, create_ms, peak_mb() - memory);
    return 0;
  }
  RunResult r = run(engine, *scene, steps, options.end_only ? 1 : 8);
  r.create_ms = create_ms;
  r.rss_mb += created_mb;
  print(engine.name(), options, engine.settings(), *scene, r);
  return 0;
}

}  // namespace gyre::bench
