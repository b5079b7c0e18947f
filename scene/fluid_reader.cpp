// Gases and liquids of a scene. See scene_parts.h and, for the format, scene_schema_fluid.h.
#include "scene/scene_parts.h"

#include "scene/fluid_words.h"
#include "scene/number_text.h"

#include <cmath>

namespace gyre {
namespace {

constexpr std::int64_t kMostCells = std::int64_t(1) << 24;      // of one of them
constexpr std::int64_t kMostParticles = std::int64_t(1) << 22;  // of one liquid
constexpr double kMostAmount = 1.0e12;
constexpr Range kZeroOrMore = Range::between(0, kMostAmount);
constexpr Range kAboveZero = Range::above_to(0, kMostAmount);
constexpr double kMostSpeed = 1.0e6;  // m/s
constexpr Range kSpeed = Range::between(-kMostSpeed, kMostSpeed);

std::string point_text(DVec3 p) {
  return "[" + rounded(p.x) + ", " + rounded(p.y) + ", " + rounded(p.z) + "]";
}

// Takes cells from what one entry and the scene may have.
void take_cells(SceneReading& reading, const Field& field, double count) {
  const std::string expected = " cells, expected at most ";
  if (!(count <= double(kMostCells)))
    field.fail("found " + rounded(count, 9) + expected + std::to_string(kMostCells));
  const std::size_t most = reading.options.limits.fluid_cells;
  reading.fluid_cells += std::size_t(count);
  if (reading.fluid_cells > most)
    field.fail("found " + std::to_string(reading.fluid_cells) +
               " cells of gases and liquids up to here, expected at most " + std::to_string(most));
}

// ------------------------------------------------------------------------------------------------- what both have

template <class Def>
void read_fluid_bounds(Members& members, Def& def) {
  const Field field = members.need("bounds");
  const FieldBounds bounds = read_bounds(field);
  const DVec3 extent = bounds.high - bounds.low;
  if (!(extent.x > 0 && extent.y > 0 && extent.z > 0))
    field.fail("found a box of no volume, expected an upper corner above the lower one along every axis");
  def.lower = bounds.low;
  def.upper = bounds.high;
}

template <class Def>
DVec3 read_inside(const Def& def, const Field& field) {
  const DVec3 p = field.place();
  const bool is_inside = p.x >= def.lower.x && p.x <= def.upper.x && p.y >= def.lower.y &&
                         p.y <= def.upper.y && p.z >= def.lower.z && p.z <= def.upper.z;
  if (!is_inside)
    field.fail("found " + point_text(p) + ", expected a point inside the bounds, " + point_text(def.lower) +
               " to " + point_text(def.upper));
  return p;
}

FluidBoundary read_side(const Field& field) {
  return field.choice<FluidBoundary>({{"periodic", FluidBoundary::periodic},
                                      {"open", FluidBoundary::open},
                                      {"closed", FluidBoundary::closed},
                                      {"no_slip", FluidBoundary::no_slip}});
}

// One word for both sides of an axis, or one for each: [lower, upper].
void read_axis(const Field& field, FluidBoundary& low, FluidBoundary& high) {
  if (!field.json().is_array()) {
    low = high = read_side(field);
    return;
  }
  field.array("one word, or two for the lower and the upper side", 2);
  low = read_side(field.element(0));
  high = read_side(field.element(1));
  if ((low == FluidBoundary::periodic) != (high == FluidBoundary::periodic))
    field.fail("found one periodic side, expected both sides of an axis periodic or none");
}

void read_boundary(const Field& field, std::array<FluidBoundary, 6>& sides) {
  if (field.json().is_string()) {
    sides.fill(read_side(field));
    return;
  }
  if (!field.json().is_object())
    field.expected("\"open\", \"closed\", or an object with a word for each axis, {\"x\", \"y\", \"z\"}");
  Members members(field, "a boundary");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const auto word = members.find_value(kAxisKeys[axis]))
      read_axis(*word, sides[2 * axis], sides[2 * axis + 1]);
  }
  members.finish();
}

void read_walls(const Field& field, const std::array<FluidBoundary, 6>& sides, std::array<Vec3, 6>& out) {
  Members members(field, "walls, by sides -x, +x, -y, +y, -z, +z");
  for (std::size_t side = 0; side < 6; ++side) {
    const auto wall = members.find_value(kSideKeys[side]);
    if (!wall) continue;
    if (sides[side] == FluidBoundary::open || sides[side] == FluidBoundary::periodic)
      wall->fail(std::string("found a wall on a side that is ") + to_string(sides[side]) +
                 ", expected the boundary closed or no_slip there");
    Members parts(*wall, "a wall");
    if (const auto velocity = parts.find_value("velocity")) {
      out[side] = velocity->vec3(kSpeed);
      const std::size_t across = side / 2;
      if (out[side][int(across)] != 0.0f)
        velocity->element(across).expected("0: a side moves in its own plane");
    }
    parts.finish();
  }
  members.finish();
}

TaylorGreen read_vortices(const Field& field) {
  Members members(field, "an initial velocity");
  members.need("type").choice<int>({{"taylor_green", 0}});
  TaylorGreen out;
  if (const auto amplitude = members.find("amplitude")) out.amplitude = amplitude->real(kSpeed);
  if (const auto waves = members.find("wave_number")) {
    waves->array("an array of 3 wave numbers, [kx, ky, 0]", 3);
    for (std::size_t axis = 0; axis < 2; ++axis)
      out.wave_number[axis] = waves->element(axis).real(Range::above_to(0, 1.0e6));
    if (waves->element(2).number() != 0.0)
      waves->element(2).expected("0: these vortices lie in the x-y plane");
  }
  members.finish();
  return out;
}

template <class Def>
void read_initial_velocity(const Field& field, Def& def) {
  if (!field.json().is_object()) {
    def.initial_velocity = field.vec3(kSpeed);
    return;
  }
  if constexpr (requires { def.vortices; }) {
    def.vortices = read_vortices(field);
  } else {
    field.expected("an array of 3 numbers: only a gas begins as vortices");
  }
}

template <class Def>
void read_probes(const SceneReading& reading, const Field& field, const Def& def,
                 std::vector<SceneProbe>& out) {
  const std::size_t count = field.array("an array of probes");
  NameTable names;
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = field.element(i);
    Members members(element, "a probe");
    SceneProbe probe;
    const Field name = members.need("name");
    probe.name = name.name(reading.options.limits.name_bytes);
    if (!names.emplace(probe.name, 0).second) name.expected("a name that no other probe here has");
    probe.position = read_inside(def, members.need("position"));
    members.finish();
    out.push_back(std::move(probe));
  }
}

template <class Def>
void read_emitters(const Field& field, Def& def) {
  constexpr bool is_gas = requires { def.buoyancy; };
  const std::size_t count = field.array("an array of emitters");
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = field.element(i);
    Members members(element, "an emitter");
    FluidEmitter emitter;
    emitter.position = read_inside(def, members.need("position"));
    emitter.radius = 0.3f;
    members.read("radius", emitter.radius, kAboveZero);
    if (is_gas) {
      members.read("density", emitter.density, Range::between(0, kMaxDensity));
      members.read("temperature", emitter.temperature, kAboveZero);
      members.read("fuel", emitter.fuel, Range::between(0, kMaxDensity));
    } else {
      members.refuse("density",
                     "only a gas has smoke; what a liquid's emitter fills has the density of the liquid");
      members.refuse("temperature", "only a gas has a temperature");
      members.refuse("fuel", "only a gas burns");
    }
    if (const auto velocity = members.find_value("velocity")) emitter.velocity = velocity->vec3(kSpeed);
    members.read("start", emitter.start);
    members.read("end", emitter.end);
    members.finish();
    def.emitters.push_back(emitter);
  }
}

template <class Def>
void read_common(SceneReading& reading, Members& members, SceneFluid& fluid, Def& def) {
  fluid.name = read_unique_name(reading, members.need("name"));
  members.read("color", fluid.color);
  read_fluid_bounds(members, def);
  if (const auto position = members.find("position")) def.pose.position = position->place();
  members.read("orientation", def.pose.orientation);
  members.read("linear_velocity", def.linear_velocity);
  members.read("angular_velocity", def.angular_velocity);
  members.read("density", def.density, Range::above_to(0, kMaxDensity));
  members.read("viscosity", def.viscosity, kZeroOrMore);
  if (const auto boundary = members.find_value("boundary")) read_boundary(*boundary, def.sides);
  if (const auto walls = members.find_value("walls")) read_walls(*walls, def.sides, def.wall_velocities);
  if (const auto velocity = members.find_value("initial_velocity")) read_initial_velocity(*velocity, def);
  if (const auto emitters = members.find_value("emitters")) read_emitters(*emitters, def);
  if (const auto probes = members.find_value("probes")) read_probes(reading, *probes, def, fluid.probes);
}

// ------------------------------------------------------------------------------------------------------------- gases

void read_cells(SceneReading& reading, const Field& field, std::array<int, 3>& out) {
  field.array("an array of 3 numbers of cells", 3);
  double count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Field cells = field.element(axis);
    const bool is_large = cells.json().is_number() && cells.json().get<double>() > double(kMostCells);
    if (is_large) cells.expected("at most " + std::to_string(kMostCells) + " cells");
    out[axis] = int(cells.integer(1, kMostCells));
    count *= out[axis];
  }
  take_cells(reading, field, count);
}

// Numbers of cells or faces. Without them: `count` times the same.
void read_numbers(Members& members, const char* key, std::size_t count, const char* places, float otherwise,
                  std::vector<float>& out) {
  const auto field = members.find_value(key);
  if (!field) {
    out.assign(count, otherwise);
    return;
  }
  const std::string expected = "an array of " + std::to_string(count) + " numbers, one for each " + places;
  field->array(expected.c_str(), std::int64_t(count));
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back(field->element(i).real());
}

void read_velocity_of_faces(const Field& field, const std::array<int, 3>& cells, GasFields& out) {
  Members members(field, "velocities of faces, x, y and z");
  std::vector<float>* const velocities[3] = {&out.velocity_x, &out.velocity_y, &out.velocity_z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t count = 1;
    for (std::size_t other = 0; other < 3; ++other)
      count *= std::size_t(cells[other]) + (other == axis ? 1 : 0);
    read_numbers(members, kAxisKeys[axis], count, "face", 0.0f, *velocities[axis]);
  }
  members.finish();
}

GasFields read_gas_state(const Field& field, const GasDef& def) {
  Members members(field, "a state of a gas");
  GasFields out;
  const std::size_t count = std::size_t(def.cells[0]) * std::size_t(def.cells[1]) * std::size_t(def.cells[2]);
  read_velocity_of_faces(members.need("velocity"), def.cells, out);
  read_numbers(members, "density", count, "cell", 0.0f, out.density);
  read_numbers(members, "temperature", count, "cell", def.ambient_temperature, out.temperature);
  read_numbers(members, "pressure", count, "cell", 0.0f, out.pressure);
  if (def.combustion) read_numbers(members, "fuel", count, "cell", 0.0f, out.fuel);
  members.finish();
  return out;
}

Combustion read_combustion(const Field& field) {
  Members members(field, "combustion");
  Combustion out;
  members.read("ignition_temperature", out.ignition_temperature, kZeroOrMore);
  members.read("burn_rate", out.burn_rate, kZeroOrMore);
  members.read("heat_release", out.heat_release, kZeroOrMore);
  members.read("heat_capacity", out.heat_capacity, kAboveZero);
  members.read("smoke_yield", out.smoke_yield, kZeroOrMore);
  members.finish();
  return out;
}

AdaptiveDomain read_adaptive_domain(const Field& field) {
  Members members(field, "an adaptive domain");
  AdaptiveDomain out;
  if (const auto margin = members.find("margin")) out.margin = int(margin->integer(1, kMostCells));
  members.read("threshold", out.threshold, Range::above_to(0, 1));
  members.finish();
  return out;
}

// ----------------------------------------------------------------------------------------------------------- liquids

// Bounds that are no whole cells are widened, but rounding does not cost a cell.
double cells_along(double extent, double cell) {
  const double cells = extent / cell;
  return max(1.0, std::ceil(cells - 1.0e-6 * max(1.0, cells)));
}

void read_fill(const Field& field, std::vector<FluidRegion>& out) {
  const std::size_t count = field.array("an array of regions, {\"box\": [low, high]}");
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = field.element(i);
    Members members(element, "a region, {\"box\": [low, high]}");
    const FieldBounds bounds = read_bounds(members.need("box"));
    out.push_back({bounds.low, bounds.high});
    members.finish();
  }
}

template <class T, class Read>
void read_particles(Members& members, const char* key, std::size_t count, std::vector<T>& out, Read read) {
  const auto field = members.find_value(key);
  if (!field) return;
  const std::string expected =
      "an array of " + std::to_string(count) + " of them, one for each particle as the positions are";
  field->array(expected.c_str(), std::int64_t(count));
  for (std::size_t i = 0; i < count; ++i) read(field->element(i), out);
}

LiquidParticles read_liquid_state(const Field& field) {
  Members members(field, "a state of a liquid");
  LiquidParticles out;
  const Field positions = members.need("positions");
  const std::size_t count = positions.array("an array of positions, one for each particle");
  if (count > std::size_t(kMostParticles))
    positions.expected("at most " + std::to_string(kMostParticles) + " particles");
  out.positions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.positions.push_back(positions.element(i).place());
  read_particles(members, "velocities", count, out.velocities,
                 [](const Field& one, std::vector<Vec3>& all) { all.push_back(one.vec3(kSpeed)); });
  if (out.velocities.empty()) out.velocities.resize(count);
  read_particles(members, "affine", count, out.affine, [](const Field& one, std::vector<float>& all) {
    one.array("an array of 9 numbers, a matrix row by row", 9);
    for (std::size_t k = 0; k < 9; ++k) all.push_back(one.element(k).real());
  });
  read_particles(members, "volumes", count, out.volumes,
                 [](const Field& one, std::vector<float>& all) { all.push_back(one.real(kAboveZero)); });
  members.finish();
  return out;
}

}  // namespace

void read_gas(SceneReading& reading, const Field& field) {
  Members members(field, "a gas");
  SceneGas gas;
  read_common(reading, members, gas, gas.def);
  read_cells(reading, members.need("cells"), gas.def.cells);
  if (const auto buoyancy = members.find("buoyancy"))
    gas.def.buoyancy = buoyancy->real(Range::between(-kMaxSurface, kMaxSurface));
  members.read("vorticity", gas.def.vorticity, Range::between(0, kMaxSurface));
  members.read("ambient_temperature", gas.def.ambient_temperature, kAboveZero);
  if (const auto advection = members.find("advection"))
    gas.def.advection = advection->choice<Advection>(
        {{"maccormack", Advection::maccormack}, {"semi_lagrangian", Advection::semi_lagrangian}});
  if (const auto combustion = members.find_value("combustion"))
    gas.def.combustion = read_combustion(*combustion);
  if (const auto domain = members.find_value("adaptive_domain"))
    gas.def.adaptive_domain = read_adaptive_domain(*domain);
  if (const auto state = members.find_value("state")) gas.def.fields = read_gas_state(*state, gas.def);
  members.finish();
  reading.scene.gases.push_back(std::move(gas));
}

void read_liquid(SceneReading& reading, const Field& field) {
  Members members(field, "a liquid");
  SceneLiquid liquid;
  LiquidDef& def = liquid.def;
  read_common(reading, members, liquid, def);
  const Field cell = members.need("cell_size");
  def.cell_size = cell.real(kAboveZero);
  const DVec3 extent = def.upper - def.lower;
  const double size = double(def.cell_size);
  take_cells(reading, cell,
             cells_along(extent.x, size) * cells_along(extent.y, size) * cells_along(extent.z, size));
  members.read("surface_tension", def.surface_tension, kZeroOrMore);
  if (const auto fill = members.find_value("fill")) read_fill(*fill, def.fill);
  if (const auto state = members.find_value("state")) def.particles = read_liquid_state(*state);
  members.finish();
  reading.scene.liquids.push_back(std::move(liquid));
}

}  // namespace gyre
