// Cloth, ropes, solids, smoke and water: time a step beside the error of the result, and the growth with size. One core unless --threads.
//
//   matter [--threads N] [--frames N] [NAME ...]      NAME: cloth, visual, folded, beam, beam4, smoke, smoke128, water, rope; all if none is given
//
// Every scene steps by 1/60 s with the defaults that its users get; `growth` is the exponent of time over elements between half the size and
// the whole. bench/soft has scenes like these beside other engines.
#include <gyre/gyre.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace gyre;

constexpr float kStep = 1.0f / 60.0f;

struct Options {
  int threads = 1;
  int frames = 120;
};

struct Run {
  double median_ms = 0.0, quartile_ms = 0.0, slowest_ms = 0.0;
  std::size_t elements = 0;
  double error = 0.0;
  std::string meaning;  // of the error
};

// Steps a world and times each step.
void time_steps(World& world, int frames, Run& run) {
  std::vector<double> ms;
  for (int i = 0; i < frames; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    if (!world.step(kStep)) {
      std::fprintf(stderr, "the world cannot step\n");
      std::exit(1);
    }
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(ms.begin(), ms.end());
  run.median_ms = ms[ms.size() / 2];
  run.quartile_ms = 0.5 * (ms[ms.size() * 3 / 4] - ms[ms.size() / 4]);
  run.slowest_ms = ms.back();
}

World make_world(const Options& options, int substeps = 4, Vec3 gravity = {0, -9.81f, 0}) {
  WorldDef def{.gravity = gravity, .threads = options.threads, .sleeping = false};
  def.stepping.substeps = substeps;
  Result<World> world = World::create(def);
  if (!world) {
    std::fprintf(stderr, "%s\n", world.error().message);
    std::exit(1);
  }
  return *std::move(world);
}

// A square of 2 m and 0.8 kg, of springs, held at two corners. The error is the mean strain of its structural springs: of what is stiff
// hardly any is right.
SoftId hang_cloth(World& world, int side, float stiffness, SoftIntegrator integrator) {
  const SoftId cloth = world.add_cloth({.grid = ClothGrid{{2, 2}, {side - 1, side - 1}},
                                        .pose = {{0, 3, 0}, {}},
                                        .area_density = 0.2f,
                                        .stretch_stiffness = stiffness,
                                        .shear_stiffness = stiffness,
                                        .self_collision = false,
                                        .settings = {.integrator = integrator}});
  world.pin(cloth, 0);
  world.pin(cloth, std::uint32_t(side - 1));
  return cloth;
}
double mean_strain(World& world, SoftId cloth, int side) {
  const SoftVertices v = world.vertices(cloth);
  const double rest = 2.0 / (side - 1);
  double sum = 0.0;
  int count = 0;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const std::size_t at = std::size_t(i + j * side);
      if (i + 1 < side) sum += std::fabs(length(v.position(at + 1) - v.position(at)) / rest - 1.0), ++count;
      if (j + 1 < side)
        sum += std::fabs(length(v.position(at + std::size_t(side)) - v.position(at)) / rest - 1.0), ++count;
    }
  }
  return 100.0 * sum / count;
}
Run cloth(const Options& options, int side, SoftIntegrator integrator) {
  World world = make_world(options);
  const SoftId sheet = hang_cloth(world, side, 1000.0f, integrator);
  Run run;
  time_steps(world, options.frames, run);
  run.elements = std::size_t(side) * std::size_t(side);
  run.error = mean_strain(world, sheet, side);
  run.meaning = "mean strain, %";
  return run;
}
// The same, dropped on a ball: it folds, and touches itself.
Run folded(const Options& options, int side) {
  World world = make_world(options);
  world.add_body({.type = BodyType::fixed, .pose = {{0, -1, 0}, {}}}, {.geometry = Box{{20, 1, 20}}});
  world.add_body({.type = BodyType::fixed, .pose = {{0, 0.5, 0}, {}}}, {.geometry = Sphere{0.25f}});
  world.add_cloth(
      {.grid = ClothGrid{{2, 2}, {side - 1, side - 1}}, .pose = {{0, 0.9, 0}, {}}, .area_density = 0.2f});
  Run run;
  // Until it lies in folds; the last half counts.
  for (int i = 0; i < options.frames / 2; ++i) world.step(kStep);
  time_steps(world, options.frames, run);
  run.elements = std::size_t(side) * std::size_t(side);
  run.error = double(world.cloth_crossings());
  run.meaning = "crossings";
  return run;
}

// A beam of 1 m, 0.267 m high, clamped at one end, under its own weight.
Run beam(const Options& options, int cells, int substeps) {
  World world = make_world(options, substeps);
  const std::array<int, 3> n{cells, std::max(1, cells * 8 / 30), std::max(1, cells * 7 / 30)};
  const Vec3 half{0.5f, 0.5f * 8.0f / 30.0f, 0.5f * 7.0f / 30.0f};
  const SoftId solid = world.add_solid({.box = SolidBox{half, n},
                                        .pose = {{0, 2, 0}, {}},
                                        .model = SolidModel::corotated,
                                        .young_modulus = 1.0e6f,
                                        .poisson_ratio = 0.3f,
                                        .settings = {.damping = 0.2f}});
  const std::uint32_t columns = std::uint32_t(n[0]) + 1;
  const std::uint32_t count = std::uint32_t(world.soft_info(solid).vertices);
  for (std::uint32_t v = 0; v < count; v += columns) world.pin(solid, v);
  const auto tip = [&] {
    double sum = 0.0;
    const SoftVertices v = world.vertices(solid);
    for (std::uint32_t i = columns - 1; i < count; i += columns) sum += v.y[i];
    return sum / (count / columns);
  };
  const double before = tip();
  Run run;
  time_steps(world, options.frames, run);
  for (int i = 0; i < 120; ++i) world.step(kStep);
  run.elements = std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]) * 5;
  // Timoshenko's beam, which hangs by 222 mm, less what an elastica of the same load falls short of small deflections.
  const double e = 1.0e6, h = 8.0 / 30.0, w = 1000.0 * 9.81, shear = e / 2.6;
  const double exact = 0.970 * (w / (8.0 * e * h * h / 12.0) + w / (2.0 * 5.0 / 6.0 * shear));
  run.error = 100.0 * ((before - tip()) / exact - 1.0);
  run.meaning = "tip against the exact one, %";
  return run;
}

// Smoke and heat rise past a ball that moves.
Run smoke(const Options& options, int cells) {
  World world = make_world(options);
  const FluidId gas =
      world.add_gas({.lower = {-1, 0, -1},
                     .upper = {1, 2, 1},
                     .cells = {cells, cells, cells},
                     .emitters = {{.position = {0, 0.3, 0}, .radius = 0.2f, .temperature = 400.0f}}});
  world.add_body({.type = BodyType::kinematic, .pose = {{-0.4, 1.0, 0}, {}}, .linear_velocity = {0.2f, 0, 0}},
                 {.geometry = Sphere{0.2f}});
  Run run;
  time_steps(world, std::max(10, options.frames / (cells > 64 ? 8 : 2)), run);
  run.elements = std::size_t(cells) * std::size_t(cells) * std::size_t(cells);
  run.error = double(world.fluid_info(gas).residual);
  run.meaning = "residual of the pressure";
  return run;
}

// A dam breaks in a tank: the liquid fills an eighth of it.
Run water(const Options& options, double particles) {
  World world = make_world(options);
  const double cell = std::cbrt(8.0 * 0.5 / particles);
  const FluidId pool = world.add_liquid(
      {.lower = {0, 0, 0}, .upper = {2, 1, 1}, .cell_size = float(cell), .fill = {{{0, 0, 0}, {0.5, 1, 1}}}});
  const double before = world.fluid_info(pool).volume;
  Run run;
  time_steps(world, std::max(10, options.frames / 2), run);
  const FluidInfo info = world.fluid_info(pool);
  run.elements = std::size_t(info.particles);
  run.error = 100.0 * (info.volume / before - 1.0);
  run.meaning = "change of volume, %";
  return run;
}

// A rope of rods hangs on one end and swings.
Run rope(const Options& options, int vertices) {
  World world = make_world(options);
  const SoftId line = world.add_rope(
      {.points = {{0, 10, 0}, {10, 10, 0}}, .segments = vertices - 1, .bend_stiffness = 0.01f});
  world.pin(line, 0);
  Run run;
  time_steps(world, options.frames, run);
  run.elements = std::size_t(vertices);
  const SoftVertices v = world.vertices(line);
  double sum = 0.0;
  for (std::size_t i = 1; i < v.size(); ++i) sum += length(v.position(i) - v.position(i - 1));
  run.error = 100.0 * (sum / 10.0 - 1.0);
  run.meaning = "change of length, %";
  return run;
}

struct Scene {
  const char* name;
  // `share`: of the full size.
  std::function<Run(const Options&, double share)> run;
};

const std::vector<Scene> kScenes = {
    {"cloth",
     [](const Options& o, double share) {
       return cloth(o, int(std::lround(100.0 * std::sqrt(share))), SoftIntegrator::implicit);
     }},
    {"visual",
     [](const Options& o, double share) {
       return cloth(o, int(std::lround(100.0 * std::sqrt(share))), SoftIntegrator::visual);
     }},
    {"folded",
     [](const Options& o, double share) { return folded(o, int(std::lround(100.0 * std::sqrt(share)))); }},
    {"beam",
     [](const Options& o, double share) { return beam(o, int(std::lround(30.0 * std::cbrt(share))), 1); }},
    {"beam4",
     [](const Options& o, double share) { return beam(o, int(std::lround(30.0 * std::cbrt(share))), 4); }},
    {"smoke", [](const Options& o, double share) { return smoke(o, share < 1.0 ? 48 : 64); }},
    {"smoke128", [](const Options& o, double share) { return smoke(o, share < 1.0 ? 96 : 128); }},
    {"water", [](const Options& o, double share) { return water(o, 1.0e5 * share); }},
    {"rope", [](const Options& o, double share) { return rope(o, int(1000 * share)); }},
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--threads" && i + 1 < argc)
      options.threads = std::atoi(argv[++i]);
    else if (argument == "--frames" && i + 1 < argc)
      options.frames = std::atoi(argv[++i]);
    else
      names.push_back(argument);
  }
  std::printf(
      "| scene | elements | ms a step | error of it | slowest | growth | error | "
      "|\n|---|---:|---:|---:|---:|---:|---:|---|\n");
  for (const Scene& scene : kScenes) {
    if (!names.empty() && std::find(names.begin(), names.end(), scene.name) == names.end()) continue;
    const Run half = scene.run(options, 0.5), whole = scene.run(options, 1.0);
    const double growth =
        std::log(whole.median_ms / half.median_ms) / std::log(double(whole.elements) / double(half.elements));
    std::printf("| %s | %zu | %.2f | %.2f | %.2f | %.2f | %.3g | %s |\n", scene.name, whole.elements,
                whole.median_ms, whole.quartile_ms, whole.slowest_ms, growth, whole.error,
                whole.meaning.c_str());
    std::fflush(stdout);
  }
  return 0;
}
