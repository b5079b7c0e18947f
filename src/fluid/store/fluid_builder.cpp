#include "fluid/store/fluid_builder.h"

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
  return check_field("pressure", fields.pressure, cells);
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
    if (one.velocity && !is_finite(*one.velocity))
      return refuse("emitters[%d].velocity is not finite", int(n));
    if (!std::isfinite(one.start) || !std::isfinite(one.end))
      return refuse("emitters[%d]: start and end must be finite", int(n));
  }
  return {};
}

Error check_fluid(const GasDef& def) {
  if (const Error e = check_box(def.lower, def.upper)) return e;
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
  if (const Error e = check_sides(def.sides, def.wall_velocities)) return e;
  if (const Error e = check_emitters(def.emitters, def.lower, def.upper)) return e;
  return def.fields ? check_fields(def) : Error{};
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

FluidEntry build_fluid(std::shared_ptr<const FluidDef> shared) {
  FluidEntry entry;
  entry.def = std::move(shared);
  const GasDef& def = entry.gas_def();
  GasBox box;
  const DVec3 size = def.upper - def.lower;
  const double sizes[3] = {size.x, size.y, size.z};
  float edges[3] = {};
  for (int axis = 0; axis < 3; ++axis) {
    box.cells[axis] = def.cells[std::size_t(axis)];
    edges[axis] = float(sizes[axis] / double(box.cells[axis]));
  }
  box.cell = {edges[0], edges[1], edges[2]};
  box.corner = def.lower;
  for (int s = 0; s < 6; ++s) {
    box.side[s] = def.sides[std::size_t(s)];
    box.wall_velocity[s] = def.wall_velocities[std::size_t(s)];
  }
  entry.gas = make_gas_grid(box, def.ambient_temperature);
  const GridShape& shape = entry.gas.shape;
  if (def.fields) {
    paste(shape, 0, def.fields->velocity_x, entry.gas.velocity[0]);
    paste(shape, 1, def.fields->velocity_y, entry.gas.velocity[1]);
    paste(shape, 2, def.fields->velocity_z, entry.gas.velocity[2]);
    paste(shape, -1, def.fields->density, entry.gas.density);
    paste(shape, -1, def.fields->temperature, entry.gas.temperature);
    paste(shape, -1, def.fields->pressure, entry.gas.pressure);
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
  for (const FluidEmitter& emitter : def.emitters) entry.emitters.push_back(make_emitter(emitter));
  return entry;
}

GasFields copy_fields(const GasGrid& grid) {
  GasFields out;
  out.velocity_x = cut_out(grid.shape, 0, grid.velocity[0]);
  out.velocity_y = cut_out(grid.shape, 1, grid.velocity[1]);
  out.velocity_z = cut_out(grid.shape, 2, grid.velocity[2]);
  out.density = cut_out(grid.shape, -1, grid.density);
  out.temperature = cut_out(grid.shape, -1, grid.temperature);
  out.pressure = cut_out(grid.shape, -1, grid.pressure);
  return out;
}

}  // namespace gyre
