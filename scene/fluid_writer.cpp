// Gases and liquids to scene files. See write_parts.h and, for the format, scene_schema_fluid.h.
#include "scene/fluid_words.h"
#include "scene/write_parts.h"

namespace gyre {
namespace {

constexpr JsonLayout kLine = JsonLayout::one_line;

void write_corners(JsonWriter& json, const char* key, const DVec3& lower, const DVec3& upper) {
  json.key(key).begin_array(kLine);
  json.value(lower);
  json.value(upper);
  json.end_array();
}

void write_boundary(JsonWriter& json, const std::array<FluidBoundary, 6>& sides,
                    const std::array<FluidBoundary, 6>& standard) {
  if (sides == standard) return;
  bool all_same = true;
  for (const FluidBoundary side : sides) all_same = all_same && side == sides[0];
  if (all_same) {
    json.field("boundary", to_string(sides[0]));
    return;
  }
  json.key("boundary").begin_object(kLine);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const FluidBoundary low = sides[2 * axis], high = sides[2 * axis + 1];
    if (low == high) {
      json.field(kAxisKeys[axis], to_string(low));
      continue;
    }
    json.key(kAxisKeys[axis]).begin_array(kLine);
    json.value(to_string(low));
    json.value(to_string(high));
    json.end_array();
  }
  json.end_object();
}

void write_walls(JsonWriter& json, const std::array<Vec3, 6>& velocities) {
  if (velocities == std::array<Vec3, 6>{}) return;
  json.key("walls").begin_object(kLine);
  for (std::size_t side = 0; side < 6; ++side) {
    if (velocities[side] == Vec3{}) continue;
    json.key(kSideKeys[side]).begin_object(kLine);
    json.field("velocity", velocities[side]);
    json.end_object();
  }
  json.end_object();
}

template <class Def>
void write_initial_velocity(JsonWriter& json, const Def& def) {
  if constexpr (requires { def.vortices; }) {
    if (def.vortices) {
      json.key("initial_velocity").begin_object(kLine);
      json.field("type", "taylor_green");
      json.field("amplitude", def.vortices->amplitude);
      json.field("wave_number", Vec3{def.vortices->wave_number[0], def.vortices->wave_number[1], 0.0f});
      json.end_object();
      return;
    }
  }
  unless_default(json, "initial_velocity", def.initial_velocity, Vec3{});
}

void write_emitters(JsonWriter& json, const std::vector<FluidEmitter>& emitters, bool is_gas) {
  if (emitters.empty()) return;
  const FluidEmitter standard;
  json.key("emitters").begin_array();
  for (const FluidEmitter& emitter : emitters) {
    json.begin_object(kLine);
    json.field("position", emitter.position);
    json.field("radius", emitter.radius);
    if (is_gas) {
      json.field("density", emitter.density);
      json.field("temperature", emitter.temperature);
      unless_default(json, "fuel", emitter.fuel, standard.fuel);
    }
    if_given(json, "velocity", emitter.velocity);
    unless_default(json, "start", emitter.start, standard.start);
    unless_default(json, "end", emitter.end, standard.end);
    json.end_object();
  }
  json.end_array();
}

void write_probes(JsonWriter& json, const std::vector<SceneProbe>& probes) {
  if (probes.empty()) return;
  json.key("probes").begin_array();
  for (const SceneProbe& probe : probes) {
    json.begin_object(kLine);
    json.field("name", probe.name);
    json.field("position", probe.position);
    json.end_object();
  }
  json.end_array();
}

template <class Def>
void write_common(JsonWriter& json, const SceneFluid& fluid, const Def& def, bool is_gas) {
  write_color(json, fluid.color);
  unless_default(json, "position", def.pose.position, DVec3{});
  unless_default(json, "orientation", def.pose.orientation, Quat{});
  unless_default(json, "linear_velocity", def.linear_velocity, Vec3{});
  unless_default(json, "angular_velocity", def.angular_velocity, Vec3{});
  json.field("density", def.density);
  unless_default(json, "viscosity", def.viscosity, 0.0f);
  write_boundary(json, def.sides, Def{}.sides);
  write_walls(json, def.wall_velocities);
  write_initial_velocity(json, def);
  write_emitters(json, def.emitters, is_gas);
  write_probes(json, fluid.probes);
}

void write_floats(JsonWriter& json, const char* key, const std::vector<float>& numbers) {
  json.key(key).begin_array(kLine);
  for (const float number : numbers) json.value(number);
  json.end_array();
}

void write_gas_state(JsonWriter& json, const GasFields& fields) {
  json.key("state").begin_object();
  json.key("velocity").begin_object();
  write_floats(json, "x", fields.velocity_x);
  write_floats(json, "y", fields.velocity_y);
  write_floats(json, "z", fields.velocity_z);
  json.end_object();
  write_floats(json, "density", fields.density);
  write_floats(json, "temperature", fields.temperature);
  write_floats(json, "pressure", fields.pressure);
  if (!fields.fuel.empty()) write_floats(json, "fuel", fields.fuel);
  json.end_object();
}

void write_combustion(JsonWriter& json, const Combustion& combustion) {
  json.key("combustion").begin_object(kLine);
  json.field("ignition_temperature", combustion.ignition_temperature);
  json.field("burn_rate", combustion.burn_rate);
  json.field("heat_release", combustion.heat_release);
  json.field("heat_capacity", combustion.heat_capacity);
  json.field("smoke_yield", combustion.smoke_yield);
  json.end_object();
}

void write_adaptive_domain(JsonWriter& json, const AdaptiveDomain& domain) {
  json.key("adaptive_domain").begin_object(kLine);
  json.field("margin", domain.margin);
  json.field("threshold", domain.threshold);
  json.end_object();
}

void write_gas(JsonWriter& json, const SceneGas& gas) {
  const GasDef standard;
  const GasDef& def = gas.def;
  json.begin_object();
  json.field("name", gas.name);
  write_corners(json, "bounds", def.lower, def.upper);
  json.key("cells").begin_array(kLine);
  for (const int cells : def.cells) json.value(cells);
  json.end_array();
  write_common(json, gas, def, true);
  json.field("buoyancy", def.buoyancy);
  json.field("vorticity", def.vorticity);
  unless_default(json, "ambient_temperature", def.ambient_temperature, standard.ambient_temperature);
  if (def.advection != standard.advection) json.field("advection", to_string(def.advection));
  if (def.combustion) write_combustion(json, *def.combustion);
  if (def.adaptive_domain) write_adaptive_domain(json, *def.adaptive_domain);
  if (def.fields) write_gas_state(json, *def.fields);
  json.end_object();
}

void write_liquid_state(JsonWriter& json, const LiquidParticles& particles) {
  json.key("state").begin_object();
  write_points(json, "positions", particles.positions);
  write_points(json, "velocities", particles.velocities);
  if (!particles.affine.empty()) {
    json.key("affine").begin_array();
    for (std::size_t i = 0; i + 8 < particles.affine.size(); i += 9) {
      json.begin_array(kLine);
      for (std::size_t k = 0; k < 9; ++k) json.value(particles.affine[i + k]);
      json.end_array();
    }
    json.end_array();
  }
  if (!particles.volumes.empty()) write_floats(json, "volumes", particles.volumes);
  json.end_object();
}

void write_liquid(JsonWriter& json, const SceneLiquid& liquid) {
  const LiquidDef& def = liquid.def;
  json.begin_object();
  json.field("name", liquid.name);
  write_corners(json, "bounds", def.lower, def.upper);
  json.field("cell_size", def.cell_size);
  write_common(json, liquid, def, false);
  unless_default(json, "surface_tension", def.surface_tension, 0.0f);
  if (!def.fill.empty()) {
    json.key("fill").begin_array();
    for (const FluidRegion& region : def.fill) {
      json.begin_object(kLine);
      write_corners(json, "box", region.lower, region.upper);
      json.end_object();
    }
    json.end_array();
  }
  if (def.particles) write_liquid_state(json, *def.particles);
  json.end_object();
}

}  // namespace

void write_fluids(JsonWriter& json, const Scene& scene) {
  if (!scene.gases.empty()) {
    json.key("gases").begin_array();
    for (const SceneGas& gas : scene.gases) write_gas(json, gas);
    json.end_array();
  }
  if (!scene.liquids.empty()) {
    json.key("liquids").begin_array();
    for (const SceneLiquid& liquid : scene.liquids) write_liquid(json, liquid);
    json.end_array();
  }
}

}  // namespace gyre
