#include "fluid/store/fluid_builder.h"

#include "fluid/store/fluid_motion.h"
#include "math/trig.h"

#include <cmath>

namespace gyre {

namespace {

constexpr double kMaxPlace = 1.0e12;  // m, as of bodies

template <class... Args>
Error refuse(const char* format, Args... args) {
  return make_error(ErrorCode::invalid_argument, format, args...);
}

bool is_good_place(DVec3 p) {
  return is_finite(p) && absolute(p.x) <= kMaxPlace && absolute(p.y) <= kMaxPlace &&
         absolute(p.z) <= kMaxPlace;
}
bool is_within(DVec3 p, DVec3 lower, DVec3 upper) {
  return p.x >= lower.x && p.x <= upper.x && p.y >= lower.y && p.y <= upper.y && p.z >= lower.z &&
         p.z <= upper.z;
}

Error check_box(DVec3 lower, DVec3 upper) {
  if (!is_good_place(lower) || !is_good_place(upper))
    return refuse("%s", "the corners of a box must be finite and within 1e12 m");
  if (lower.x < upper.x && lower.y < upper.y && lower.z < upper.z) return {};
  return refuse(
      "upper is (%g, %g, %g) and lower (%g, %g, %g); every component of upper must be the larger one",
      upper.x, upper.y, upper.z, lower.x, lower.y, lower.z);
}

Error check_sides(const std::array<FluidBoundary, 6>& sides, const std::array<Vec3, 6>& wall_velocities) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool low = sides[std::size_t(2 * axis)] == FluidBoundary::periodic;
    const bool high = sides[std::size_t(2 * axis + 1)] == FluidBoundary::periodic;
    if (low != high)
      return refuse("side %d is periodic and the opposite one is not; both must be",
                    low ? 2 * axis : 2 * axis + 1);
  }
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (int(sides[s]) > int(FluidBoundary::no_slip)) return refuse("sides[%d] is no boundary", int(s));
    if (!is_finite(wall_velocities[s])) return refuse("wall_velocities[%d] is not finite", int(s));
  }
  return {};
}

Error check_range(const char* name, double value, double low, const char* bound) {
  if (value >= low && value < 1.0e30) return {};
  return refuse("%s is %g; it must be finite and %s", name, value, bound);
}

// The faces of an axis, or the cells (-1), as a list without ghosts.
template <class Fn>
void for_places(const GridShape& shape, int faces, Fn&& fn) {
  for (int k = 0; k < shape.cells[2] + (faces == 2 ? 1 : 0); ++k) {
    for (int j = 0; j < shape.cells[1] + (faces == 1 ? 1 : 0); ++j) {
      for (int i = 0; i < shape.cells[0] + (faces == 0 ? 1 : 0); ++i) fn(shape.at(i, j, k), i, j, k);
    }
  }
}
std::size_t count_places(const std::array<int, 3>& cells, int faces) {
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis)
    count *= std::size_t(cells[std::size_t(axis)] + (axis == faces ? 1 : 0));
  return count;
}

Error check_field(const char* name, const std::vector<float>& field, std::size_t count) {
  if (field.size() != count)
    return refuse("fields.%s has %zu numbers; it must have %zu", name, field.size(), count);
  for (const float one : field)
    if (!std::isfinite(one)) return refuse("fields.%s has a number that is not finite", name);
  return {};
}
Error check_fields(const GasDef& def) {
  const GasFields& fields = *def.fields;
  if (const Error e = check_field("velocity_x", fields.velocity_x, count_places(def.cells, 0))) return e;
  if (const Error e = check_field("velocity_y", fields.velocity_y, count_places(def.cells, 1))) return e;
  if (const Error e = check_field("velocity_z", fields.velocity_z, count_places(def.cells, 2))) return e;
  const std::size_t cells = count_places(def.cells, -1);
  if (const Error e = check_field("density", fields.density, cells)) return e;
  if (const Error e = check_field("temperature", fields.temperature, cells)) return e;
  if (const Error e = check_field("pressure", fields.pressure, cells)) return e;
  return fields.fuel.empty() ? Error{} : check_field("fuel", fields.fuel, cells);
}

Error check_combustion(const Combustion& combustion) {
  const auto check = [](const char* name, float value, double low, const char* bound) {
    const Error e = check_range(name, double(value), low, bound);
    return e ? refuse("combustion.%s", e.message) : e;
  };
  constexpr double kMinPositive = 1.0e-30;  // in the units of each setting: not zero
  if (const Error e = check("ignition_temperature", combustion.ignition_temperature, 0.0, "at least 0"))
    return e;
  if (const Error e = check("burn_rate", combustion.burn_rate, 0.0, "at least 0")) return e;
  if (const Error e = check("heat_release", combustion.heat_release, 0.0, "at least 0")) return e;
  if (const Error e = check("heat_capacity", combustion.heat_capacity, kMinPositive, "above 0")) return e;
  return check("smoke_yield", combustion.smoke_yield, 0.0, "at least 0");
}

void paste(const GridShape& shape, int faces, const std::vector<float>& from, Array<float>& to) {
  std::size_t n = 0;
  for_places(shape, faces, [&](int c, int, int, int) { to[std::size_t(c)] = from[n++]; });
}
std::vector<float> cut_out(const GridShape& shape, int faces, const Array<float>& from) {
  std::vector<float> out;
  for_places(shape, faces, [&](int c, int, int, int) { out.push_back(from[std::size_t(c)]); });
  return out;
}

void set_vortices(const TaylorGreen& vortices, GasGrid& grid) {
  const double a = double(vortices.amplitude), kx = double(vortices.wave_number[0]),
               ky = double(vortices.wave_number[1]);
  const double hx = double(grid.box.cell.x), hy = double(grid.box.cell.y);
  for_places(grid.shape, 0, [&](int c, int i, int j, int) {
    grid.velocity[0][std::size_t(c)] = float(a * sin_cos(kx * hx * i).sin * sin_cos(ky * hy * (j + 0.5)).cos);
  });
  for_places(grid.shape, 1, [&](int c, int i, int j, int) {
    grid.velocity[1][std::size_t(c)] =
        float(-a * (kx / ky) * sin_cos(kx * hx * (i + 0.5)).cos * sin_cos(ky * hy * j).sin);
  });
}

Error check_particles(const LiquidDef& def) {
  const LiquidParticles& particles = *def.particles;
  const std::size_t count = particles.positions.size();
  if (particles.velocities.size() != count)
    return refuse("particles: there are %zu positions and %zu velocities", count,
                  particles.velocities.size());
  if (!particles.affine.empty() && particles.affine.size() != 9 * count)
    return refuse("particles.affine has %zu numbers; it must have none or %zu", particles.affine.size(),
                  9 * count);
  if (!particles.volumes.empty() && particles.volumes.size() != count)
    return refuse("particles.volumes has %zu numbers; it must have none or %zu", particles.volumes.size(),
                  count);
  for (const float one : particles.volumes)
    if (!(one > 0.0f) || !std::isfinite(one))
      return refuse("particles.volumes has %g; each must be finite and above 0", double(one));
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_good_place(particles.positions[i]) || !is_within(particles.positions[i], def.lower, def.upper))
      return refuse("particles.positions[%d] lies outside the box of the liquid", int(i));
    if (!is_finite(particles.velocities[i])) return refuse("particles.velocities[%d] is not finite", int(i));
  }
  for (const float one : particles.affine)
    if (!std::isfinite(one)) return refuse("%s", "particles.affine has a number that is not finite");
  return {};
}

// Of two boxes.
double shared_volume(DVec3 lower_a, DVec3 upper_a, DVec3 lower_b, DVec3 upper_b) {
  const double x = min(upper_a.x, upper_b.x) - max(lower_a.x, lower_b.x);
  const double y = min(upper_a.y, upper_b.y) - max(lower_a.y, lower_b.y);
  const double z = min(upper_a.z, upper_b.z) - max(lower_a.z, lower_b.z);
  return x > 0.0 && y > 0.0 && z > 0.0 ? x * y * z : 0.0;
}

// Whole cells that cover the box.
std::array<int, 3> liquid_cells(const LiquidDef& def) {
  const DVec3 size = def.upper - def.lower;
  const double sizes[3] = {size.x, size.y, size.z};
  std::array<int, 3> cells{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // A box of whole cells has no more: the float nearest to the edge of a cell may be 2^-24 of it too short, and the corners are rounded too.
    constexpr double kRounding = 1.0 / (1 << 23);
    const double count_of_edges = sizes[axis] / double(def.cell_size);
    const double count =
        std::ceil(count_of_edges - kRounding * (count_of_edges > 1.0 ? count_of_edges : 1.0));
    cells[axis] = count < 1.0 ? 1 : count < double(kMaxFluidCells) ? int(count) : int(kMaxFluidCells);
  }
  return cells;
}

template <class Def>
GasBox box_of(const Def& def, std::array<int, 3> cells, const double (&edges)[3]) {
  GasBox box;
  for (int axis = 0; axis < 3; ++axis) box.cells[axis] = cells[std::size_t(axis)];
  box.cell = {float(edges[0]), float(edges[1]), float(edges[2])};
  box.corner = def.lower;
  for (int s = 0; s < 6; ++s) {
    box.side[s] = def.sides[std::size_t(s)];
    box.wall_velocity[s] = def.wall_velocities[std::size_t(s)];
  }
  return box;
}

// A gas at rest; of one with an adaptive domain the window that holds nothing.
void build_at_rest(const GasDef& def, FluidEntry& entry) {
  const DVec3 size = def.upper - def.lower;
  const double edges[3] = {size.x / double(def.cells[0]), size.y / double(def.cells[1]),
                           size.z / double(def.cells[2])};
  const GasBox box = box_of(def, def.cells, edges);
  entry.gas = def.adaptive_domain ? make_gas_grid(box, CellBox{}, def.ambient_temperature)
                                  : make_gas_grid(box, def.ambient_temperature);
  if (def.combustion) entry.gas.fuel.resize(std::size_t(entry.gas.shape.size), 0.0f);
}
void build_at_rest(const LiquidDef& def, FluidEntry& entry) {
  const double size = double(def.cell_size);
  entry.liquid = make_liquid_grid(box_of(def, liquid_cells(def), {size, size, size}));
}

void build(const GasDef& def, FluidEntry& entry) {
  build_at_rest(def, entry);
  if (!def.fields && !def.vortices && def.initial_velocity == Vec3{}) return;
  // The first step shrinks the window of an adaptive domain.
  if (def.adaptive_domain) set_gas_window(entry.gas, whole_window(entry.gas.whole));
  const GasBox& box = entry.gas.box;
  const GridShape& shape = entry.gas.shape;
  if (def.fields) {
    paste(shape, 0, def.fields->velocity_x, entry.gas.velocity[0]);
    paste(shape, 1, def.fields->velocity_y, entry.gas.velocity[1]);
    paste(shape, 2, def.fields->velocity_z, entry.gas.velocity[2]);
    paste(shape, -1, def.fields->density, entry.gas.density);
    paste(shape, -1, def.fields->temperature, entry.gas.temperature);
    paste(shape, -1, def.fields->pressure, entry.gas.pressure);
    if (def.combustion && !def.fields->fuel.empty()) paste(shape, -1, def.fields->fuel, entry.gas.fuel);
  } else if (def.vortices) {
    set_vortices(*def.vortices, entry.gas);
  } else {
    const float velocity[3] = {def.initial_velocity.x, def.initial_velocity.y, def.initial_velocity.z};
    for (int axis = 0; axis < 3; ++axis) {
      if (!box.flat(axis))
        for_places(shape, axis,
                   [&](int c, int, int, int) { entry.gas.velocity[axis][std::size_t(c)] = velocity[axis]; });
    }
  }
  // As at the end of a step, so that a reading before the first one is right at periodic sides too.
  const bool periodic[3] = {box.periodic(0), box.periodic(1), box.periodic(2)};
  for (Array<float>* const field : {&entry.gas.density, &entry.gas.temperature, &entry.gas.pressure})
    wrap_ghosts(shape, periodic, field->data());
  if (def.combustion) wrap_ghosts(shape, periodic, entry.gas.fuel.data());
  for (Array<float>& field : entry.gas.velocity) wrap_ghosts(shape, periodic, field.data());
}

void build(const LiquidDef& def, FluidEntry& entry) { build_at_rest(def, entry); }

// Within the box and finite.
bool is_good_column(const GasBox& box, int axis, const Array<float>& column) {
  const float edge = axis == 0 ? box.cell.x : axis == 1 ? box.cell.y : box.cell.z;
  for (const float at : column)
    if (!(at >= 0.0f && at <= float(box.cells[axis]) * edge)) return false;
  return true;
}

GasEmitter make_emitter(const FluidEmitter& emitter) {
  GasEmitter out;
  out.position = emitter.position, out.radius = emitter.radius;
  out.density = emitter.density, out.temperature = emitter.temperature;
  out.has_velocity = emitter.velocity.has_value();
  if (emitter.velocity) out.velocity = *emitter.velocity;
  out.start = emitter.start, out.end = emitter.end;
  return out;
}
FluidEmitter emitter_def(const GasEmitter& emitter) {
  FluidEmitter out;
  out.position = emitter.position, out.radius = emitter.radius;
  out.density = emitter.density, out.temperature = emitter.temperature;
  if (emitter.has_velocity) out.velocity = emitter.velocity;
  out.start = emitter.start, out.end = emitter.end;
  return out;
}

}  // namespace

Error check_emitters(std::span<const FluidEmitter> emitters, DVec3 lower, DVec3 upper) {
  for (std::size_t n = 0; n < emitters.size(); ++n) {
    const FluidEmitter& one = emitters[n];
    if (!is_good_place(one.position) || !is_within(one.position, lower, upper))
      return refuse("emitters[%d].position is (%g, %g, %g); it must lie in the box of the fluid", int(n),
                    one.position.x, one.position.y, one.position.z);
    if (!(one.radius > 0.0f) || !std::isfinite(one.radius))
      return refuse("emitters[%d].radius is %g; it must be finite and above 0", int(n), double(one.radius));
    if (!(one.density >= 0.0f) || !std::isfinite(one.density))
      return refuse("emitters[%d].density is %g; it must be finite and at least 0", int(n),
                    double(one.density));
    if (!(one.temperature > 0.0f) || !std::isfinite(one.temperature))
      return refuse("emitters[%d].temperature is %g; it must be finite and above 0", int(n),
                    double(one.temperature));
    if (!(one.fuel >= 0.0f) || !std::isfinite(one.fuel))
      return refuse("emitters[%d].fuel is %g; it must be finite and at least 0", int(n), double(one.fuel));
    if (one.velocity && !is_finite(*one.velocity))
      return refuse("emitters[%d].velocity is not finite", int(n));
    if (!std::isfinite(one.start) || !std::isfinite(one.end))
      return refuse("emitters[%d]: start and end must be finite", int(n));
  }
  return {};
}

Error check_frame(const Pose& pose, Vec3 linear_velocity, Vec3 angular_velocity) {
  if (!is_good_place(pose.position)) return refuse("%s", "pose.position must be finite and within 1e12 m");
  const Quat& q = pose.orientation;
  const double square = double(q.x) * double(q.x) + double(q.y) * double(q.y) + double(q.z) * double(q.z) +
                        double(q.w) * double(q.w);
  if (!(square > 1.0e-12) || !(square < 1.0e12))
    return refuse("pose.orientation is (%g, %g, %g, %g); it must be a rotation", double(q.x), double(q.y),
                  double(q.z), double(q.w));
  if (!is_finite(linear_velocity)) return refuse("%s", "linear_velocity is not finite");
  if (!is_finite(angular_velocity)) return refuse("%s", "angular_velocity is not finite");
  return {};
}

Error check_fluid(const GasDef& def) {
  if (const Error e = check_box(def.lower, def.upper)) return e;
  if (const Error e = check_frame(def.pose, def.linear_velocity, def.angular_velocity)) return e;
  std::int64_t cells = 1;
  for (const int count : def.cells) {
    if (count < 1 || count > kMaxFluidCells) return refuse("cells has %d; each must be at least 1", count);
    cells *= std::int64_t(count);
    if (cells > kMaxFluidCells)
      return refuse("a gas of %d x %d x %d cells is too large: at most %d cells", def.cells[0], def.cells[1],
                    def.cells[2], int(kMaxFluidCells));
  }
  if (const Error e = check_range("density", double(def.density), 1.0e-30, "above 0")) return e;
  if (const Error e = check_range("viscosity", double(def.viscosity), 0.0, "at least 0")) return e;
  if (const Error e = check_range("vorticity", double(def.vorticity), 0.0, "at least 0")) return e;
  if (const Error e = check_range("ambient_temperature", double(def.ambient_temperature), 1.0e-30, "above 0"))
    return e;
  if (!std::isfinite(def.buoyancy)) return refuse("buoyancy is %g; it must be finite", double(def.buoyancy));
  if (int(def.advection) > int(Advection::semi_lagrangian))
    return refuse("%s", "advection is no way of advection");
  if (!is_finite(def.initial_velocity)) return refuse("%s", "initial_velocity is not finite");
  if (def.vortices) {
    const TaylorGreen& v = *def.vortices;
    if (!std::isfinite(v.amplitude) || !std::isfinite(v.wave_number[0]) || !std::isfinite(v.wave_number[1]) ||
        v.wave_number[1] == 0.0f)
      return refuse("%s", "vortices: amplitude and wave_number must be finite, and wave_number[1] not 0");
  }
  if (def.adaptive_domain) {
    const AdaptiveDomain& domain = *def.adaptive_domain;
    if (domain.margin < 1 || domain.margin > kMaxFluidCells)
      return refuse("adaptive_domain.margin is %d; it must be from 1 to %d", domain.margin,
                    int(kMaxFluidCells));
    if (!(domain.threshold > 0.0f && domain.threshold <= 1.0f))
      return refuse("adaptive_domain.threshold is %g; it must be above 0 and at most 1",
                    double(domain.threshold));
  }
  if (const Error e = check_sides(def.sides, def.wall_velocities)) return e;
  if (const Error e = check_emitters(def.emitters, def.lower, def.upper)) return e;
  if (def.combustion)
    if (const Error e = check_combustion(*def.combustion)) return e;
  return def.fields ? check_fields(def) : Error{};
}

Error check_fluid(const LiquidDef& def) {
  if (const Error e = check_box(def.lower, def.upper)) return e;
  if (const Error e = check_frame(def.pose, def.linear_velocity, def.angular_velocity)) return e;
  if (const Error e = check_range("cell_size", double(def.cell_size), 1.0e-9, "above 0")) return e;
  const std::array<int, 3> cells = liquid_cells(def);
  if (double(cells[0]) * double(cells[1]) * double(cells[2]) > double(kMaxFluidCells))
    return refuse("a liquid of %d x %d x %d cells is too large: at most %d cells", cells[0], cells[1],
                  cells[2], int(kMaxFluidCells));
  if (const Error e = check_range("density", double(def.density), 1.0e-30, "above 0")) return e;
  if (const Error e = check_range("viscosity", double(def.viscosity), 0.0, "at least 0")) return e;
  if (const Error e = check_range("surface_tension", double(def.surface_tension), 0.0, "at least 0"))
    return e;
  if (!is_finite(def.initial_velocity)) return refuse("%s", "initial_velocity is not finite");
  if (const Error e = check_sides(def.sides, def.wall_velocities)) return e;
  if (const Error e = check_emitters(def.emitters, def.lower, def.upper)) return e;
  const double per_cell = cells[0] == 1 || cells[1] == 1 || cells[2] == 1 ? 4.0 : 8.0;
  const double size = double(def.cell_size);
  double particles = 0.0;
  for (std::size_t n = 0; n < def.fill.size(); ++n) {
    if (const Error e = check_box(def.fill[n].lower, def.fill[n].upper))
      return refuse("fill[%d]: %s", int(n), e.message);
    particles += per_cell * shared_volume(def.fill[n].lower, def.fill[n].upper, def.lower, def.upper) /
                 (size * size * size);
  }
  if (def.particles) particles = double(def.particles->positions.size());
  if (particles > double(kMaxLiquidParticles))
    return refuse("a liquid of %.4g particles is too large: at most %d particles", particles,
                  kMaxLiquidParticles);
  return def.particles ? check_particles(def) : Error{};
}

std::int64_t count_cells(const FluidDef& def) {
  const auto* const gas = std::get_if<GasDef>(&def);
  const std::array<int, 3> cells = gas != nullptr ? gas->cells : liquid_cells(std::get<LiquidDef>(def));
  return std::int64_t(cells[0]) * std::int64_t(cells[1]) * std::int64_t(cells[2]);
}

void set_emitters(FluidEntry& entry, std::span<const FluidEmitter> emitters) {
  entry.emitters.clear(), entry.emitter_fuel.clear();
  for (const FluidEmitter& emitter : emitters) {
    entry.emitters.push_back(make_emitter(emitter));
    if (entry.burns()) entry.emitter_fuel.push_back(emitter.fuel);
  }
}

std::vector<FluidEmitter> emitter_defs(const FluidEntry& entry) {
  std::vector<FluidEmitter> out;
  for (std::size_t n = 0; n < entry.emitters.size(); ++n) {
    out.push_back(emitter_def(entry.emitters[n]));
    if (n < entry.emitter_fuel.size()) out.back().fuel = entry.emitter_fuel[n];
  }
  return out;
}

FluidEntry build_fluid(std::shared_ptr<const FluidDef> def, FluidStart start) {
  FluidEntry entry;
  entry.def = std::move(def);
  std::visit(
      [&](const auto& one) {
        start == FluidStart::rest ? build_at_rest(one, entry) : build(one, entry);
        set_emitters(entry, one.emitters);
        set_frame(entry, {{one.pose.position, normalized(one.pose.orientation)},
                          one.linear_velocity,
                          one.angular_velocity});
      },
      *entry.def);
  return entry;
}

bool fill_liquid(FluidEntry& entry, const GasSolids& solids, FunctionRef<void(const FluidWindow&)> cut) {
  const LiquidDef& def = entry.liquid_def();
  LiquidGrid& grid = entry.liquid;
  if (def.particles) {
    const LiquidParticles& from = *def.particles;
    const float volume = particle_volume(grid.box);
    for (std::size_t i = 0; i < from.positions.size(); ++i) {
      add_particle(grid, difference(from.positions[i], grid.box.corner), from.velocities[i],
                   from.volumes.empty() ? volume : from.volumes[i]);
      if (from.affine.empty()) continue;
      for (std::size_t k = 0; k < 9; ++k)
        grid.affine[k][std::size_t(grid.particles() - 1)] = from.affine[9 * i + k];
    }
  } else {
    for (const FluidRegion& region : def.fill)
      fill_liquid_box(grid, region.lower, region.upper, def.initial_velocity, solids);
  }
  find_liquid_fields(grid, solids, cut);
  return grid.particles() <= kMaxLiquidParticles;
}

bool restore_window(FluidEntry& entry) {
  if (!entry.is_adaptive()) return true;
  GasGrid& gas = entry.gas;
  if (gas.window.size() != 1) return false;
  const CellBox cells = gas.window[0];
  for (int axis = 0; axis < 3; ++axis) {
    if (cells.low[axis] < 0 || cells.high[axis] <= cells.low[axis] ||
        cells.high[axis] > gas.whole.cells[axis])
      return false;
  }
  const FluidWindow window = window_around(gas.whole, cells);
  if (!(window.cells() == cells)) return false;
  gas.box = window.box, gas.shape = window.shape;
  return true;
}

bool fits_definition(const FluidEntry& entry) {
  const std::size_t size = std::size_t(entry.shape().size);
  if (!entry.is_liquid()) {
    const GasGrid& gas = entry.gas;
    bool good = gas.density.size() == size && gas.temperature.size() == size && gas.pressure.size() == size;
    good = good && gas.fuel.size() == (entry.burns() ? size : 0);
    good = good && entry.emitter_fuel.size() == (entry.burns() ? entry.emitters.size() : 0);
    for (const Array<float>& faces : gas.velocity) good = good && faces.size() == size;
    return good;
  }
  const LiquidGrid& liquid = entry.liquid;
  const std::size_t count = liquid.volume.size();
  bool good = count <= std::size_t(kMaxLiquidParticles) && liquid.surface.size() == size &&
              liquid.pressure.size() == size;
  for (const Array<float>& faces : liquid.velocity) good = good && faces.size() == size;
  for (const Array<float>& column : liquid.motion) good = good && column.size() == count;
  for (const Array<float>& column : liquid.affine) good = good && column.size() == count;
  for (int axis = 0; axis < 3; ++axis)
    good = good && liquid.position[axis].size() == count &&
           is_good_column(liquid.box, axis, liquid.position[axis]);
  return good;
}

LiquidParticles copy_particles(const LiquidGrid& grid) {
  LiquidParticles out;
  for (std::size_t i = 0; i < std::size_t(grid.particles()); ++i) {
    out.positions.push_back(grid.box.corner + DVec3{double(grid.position[0][i]), double(grid.position[1][i]),
                                                    double(grid.position[2][i])});
    out.velocities.push_back({grid.motion[0][i], grid.motion[1][i], grid.motion[2][i]});
    out.volumes.push_back(grid.volume[i]);
    for (std::size_t k = 0; k < 9; ++k) out.affine.push_back(grid.affine[k][i]);
  }
  return out;
}

GasFields copy_fields(const GasGrid& part) {
  // A definition holds all cells.
  GasGrid whole;
  if (!part.window.empty()) whole = part, set_gas_window(whole, whole_window(part.whole));
  const GasGrid& grid = part.window.empty() ? part : whole;
  GasFields out;
  out.velocity_x = cut_out(grid.shape, 0, grid.velocity[0]);
  out.velocity_y = cut_out(grid.shape, 1, grid.velocity[1]);
  out.velocity_z = cut_out(grid.shape, 2, grid.velocity[2]);
  out.density = cut_out(grid.shape, -1, grid.density);
  out.temperature = cut_out(grid.shape, -1, grid.temperature);
  out.pressure = cut_out(grid.shape, -1, grid.pressure);
  if (!grid.fuel.empty()) out.fuel = cut_out(grid.shape, -1, grid.fuel);
  return out;
}

}  // namespace gyre
