// What gyre simulate prints at the end. See summary.h.
#include "summary.h"

#include "fluid_figures.h"
#include "scene/json_writer.h"
#include "scene/number_text.h"

#include <algorithm>
#include <cstdio>

namespace gyre {
namespace {

struct WallTimes {
  double median = 0, mean = 0, p99 = 0, max = 0;  // ms
};

WallTimes wall_times(std::vector<float> times) {
  if (times.empty()) return {};
  std::sort(times.begin(), times.end());
  double sum = 0;
  for (const float time : times) sum += double(time);
  const std::size_t n = times.size();
  // The smallest time that at least 99 % of the steps keep.
  const std::size_t rank = (99 * n + 99) / 100 - 1;
  return {0.5 * (double(times[(n - 1) / 2]) + double(times[n / 2])), sum / double(n), double(times[rank]),
          double(times.back())};
}

std::string counted(long long count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

// ", 1 gas, 2 liquids (9000 particles)"; empty without fluids.
std::string fluids_text(const SceneRunner& runner) {
  std::string out;
  if (!runner.gases().empty())
    out += ", " + counted(static_cast<long long>(runner.gases().size()), "gas", "gases");
  if (!runner.liquids().empty()) {
    out += ", " + counted(static_cast<long long>(runner.liquids().size()), "liquid", "liquids") + " (" +
           counted(fluid_figures(runner).liquid_particles, "particle", "particles") + ")";
  }
  return out;
}

}  // namespace

std::string hash_text(const World& world) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(world.hash()));
  return text;
}

std::string summary_text(const SceneRunner& runner, const RunFigures& figures) {
  const World& world = runner.world();
  const WorldStats counts = world.stats();
  const Energy energy = world.energy();
  const WallTimes times = wall_times(figures.step_ms);
  std::string out;
  if (!runner.scene().name.empty()) out += runner.scene().name + ": ";
  out += counted(counts.bodies, "body", "bodies") + ", " + counted(counts.joints, "joint", "joints");
  if (counts.softs > 0) {
    const auto add = [&](std::size_t count, const char* one, const char* many) {
      if (count > 0) out += ", " + counted(static_cast<long long>(count), one, many);
    };
    add(runner.ropes().size(), "rope", "ropes");
    add(runner.cloths().size(), "cloth", "cloths");
    add(runner.soft_bodies().size(), "soft body", "soft bodies");
    out += " (" + counted(counts.soft_vertices, "vertex", "vertices") + ")";
  }
  out += fluids_text(runner) + "\n";
  out += counted(static_cast<long long>(runner.steps()), "step", "steps") + ", " + rounded(runner.time(), 4) +
         " s simulated in " + rounded(figures.wall_seconds, 3) + " s";
  if (figures.wall_seconds > 0 && runner.steps() > 0) {
    out += " (" + rounded(runner.time() / figures.wall_seconds, 3) + " times real time)";
  }
  out += "\n";
  if (runner.steps() > 0) {
    out += "step: median " + rounded(times.median, 3) + " ms, mean " + rounded(times.mean, 3) +
           " ms, 99 % within " + rounded(times.p99, 3) + " ms, longest " + rounded(times.max, 3) + " ms\n";
  }
  out += "end: " + counted(counts.awake_bodies, "body", "bodies") + " awake, " +
         counted(counts.contact_points, "contact point", "contact points") + ", deepest overlap " +
         rounded(1.0e3 * double(world.max_penetration()), 3) + " mm\n";
  out += "energy: " + rounded(energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic, 4) +
         " J (kinetic " + rounded(energy.kinetic, 4) + ", potential " + rounded(energy.potential, 4) +
         ", elastic " + rounded(energy.elastic, 4);
  if (counts.softs > 0) out += ", soft elastic " + rounded(energy.soft_elastic, 4);
  out += ")\n";
  return out;
}

std::string times_text(const RunFigures& figures) {
  if (figures.stages.empty()) return {};
  std::string out = "stages of a step, mean:\n";
  for (const StageMean& stage : figures.stages) {
    char line[96];
    const double share = figures.stages_step_ms > 0 ? 100 * stage.ms / figures.stages_step_ms : 0;
    std::snprintf(line, sizeof line, "  %-18s %9.4f ms  %5.1f %%\n", stage.name.c_str(), stage.ms, share);
    out += line;
  }
  return out;
}

std::string explanations_text(const RunFigures& figures) {
  std::string out;
  for (const auto& [name, words] : figures.explanations) out += words + "\n";
  return out;
}

std::string summary_json(const SceneRunner& runner, const RunFigures& figures) {
  const World& world = runner.world();
  const WorldStats counts = world.stats();
  const Energy energy = world.energy();
  const WallTimes times = wall_times(figures.step_ms);
  JsonWriter json;
  json.begin_object();
  json.field("scene", runner.scene().name);
  json.field("steps", std::int64_t(runner.steps()));
  json.field("time", runner.time());
  json.field("bodies", counts.bodies);
  json.field("awake", counts.awake_bodies);
  json.field("joints", counts.joints);
  json.field("ropes", std::int64_t(runner.ropes().size()));
  json.field("cloths", std::int64_t(runner.cloths().size()));
  json.field("soft_bodies", std::int64_t(runner.soft_bodies().size()));
  json.field("particles", counts.soft_vertices);
  const FluidFigures fluids = fluid_figures(runner);
  json.field("gases", std::int64_t(runner.gases().size()));
  json.field("liquids", std::int64_t(runner.liquids().size()));
  json.field("liquid_particles", std::int64_t(fluids.liquid_particles));
  json.field("liquid_volume", fluids.liquid_volume);
  json.field("smoke_mass", fluids.smoke_mass);
  json.field("fuel_mass", fluids.fuel_mass);
  json.field("heat_rate", fluids.heat_rate);
  json.field("pairs", counts.pairs);
  json.field("contacts", counts.contact_points);
  json.field("max_penetration", world.max_penetration());
  json.key("step_ms").begin_object(JsonLayout::one_line);
  json.field("median", float(times.median));
  json.field("mean", float(times.mean));
  json.field("p99", float(times.p99));
  json.field("max", float(times.max));
  json.end_object();
  if (!figures.stages.empty()) {
    json.key("stage_ms").begin_object(JsonLayout::one_line);
    for (const StageMean& stage : figures.stages) json.field(stage.name.c_str(), float(stage.ms));
    json.end_object();
  }
  if (!figures.explanations.empty()) {
    json.key("explanations").begin_object();
    for (const auto& [name, words] : figures.explanations) json.field(name.c_str(), words);
    json.end_object();
  }
  json.field("energy", energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic);
  json.field("kinetic_energy", energy.kinetic);
  json.field("potential_energy", energy.potential);
  json.field("elastic_energy", energy.elastic);
  json.field("soft_elastic_energy", energy.soft_elastic);
  json.field("hash", hash_text(world));
  json.end_object();
  return json.take();
}

}  // namespace gyre
