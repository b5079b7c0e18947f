// Commands field by field. A structured binding takes each struct apart; it does not compile if a field was added
// that is missing here. std::visit does the same for a new command.
#include "io/codec/command_codec.h"

#include "io/codec/enum_counts.h"

#include <type_traits>

namespace gyre {

namespace {

template <class T, class Of>
concept Is = std::is_same_v<std::remove_const_t<T>, Of>;

// Passes fields to a ByteWriter or reads them from a ByteReader, so one list of fields serves both.
class FieldWriter {
 public:
  explicit FieldWriter(ByteWriter& out) : out_(out) {}
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void number(const T& value) { out_.put(value); }
  template <class Tag>
  void id(const Id<Tag>& value) {
    out_.put(value.index), out_.put(value.generation);
  }
  void shape(const AnyShape& value) { write_shape(out_, value); }
  template <class T>
  void count(const std::vector<T>& list) {
    out_.put(std::uint64_t(list.size()));
  }
  template <class T>
  bool has(const std::optional<T>& value) {
    out_.put(value.has_value());
    return value.has_value();
  }

 private:
  ByteWriter& out_;
};

class FieldReader {
 public:
  FieldReader(ByteReader& in, const GeometryTable& geometry, std::uint16_t world)
      : in_(in), geometry_(geometry), world_(world) {}
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void number(T& value) { value = in_.get<T>(); }
  template <class Tag>
  void id(Id<Tag>& value) {
    value.index = in_.get<std::uint32_t>();
    value.generation = in_.get<std::uint16_t>();
    value.world = value.generation != 0 ? world_ : std::uint16_t(0);
  }
  void shape(AnyShape& value) { value = read_shape(in_, geometry_); }
  template <class T>
  void count(std::vector<T>& list) {
    // A shape takes more, an emitter without a velocity this; a term is stored without gaps.
    constexpr std::size_t kMinBytes = std::is_same_v<T, ShapeDef>       ? 64
                                      : std::is_same_v<T, FluidEmitter> ? 53
                                      : std::is_same_v<T, CouplingTerm> ? 11
                                                                        : sizeof(T);
    list.resize(in_.get_count(kMinBytes));
  }
  template <class T>
  bool has(std::optional<T>& value) {
    if (!in_.get<bool>()) return false;
    value.emplace();
    return true;
  }
  void fail() { in_.fail(); }

 private:
  ByteReader& in_;
  const GeometryTable& geometry_;
  std::uint16_t world_;
};

// ------------------------------------------------------------------------------------------------------------- values

template <class C, class T>
requires(std::is_arithmetic_v<std::remove_const_t<T>> ||
         std::is_enum_v<std::remove_const_t<T>>) void fields(C& c, T& value) {
  c.number(value);
}
template <class C, class Tag>
void fields(C& c, Id<Tag>& value) {
  c.id(value);
}
template <class C, class Tag>
void fields(C& c, const Id<Tag>& value) {
  c.id(value);
}
template <class C, Is<AnyShape> T>
void fields(C& c, T& value) {
  c.shape(value);
}

template <class C, class... Fields>
void all(C& c, Fields&... values);

template <class C, Is<Vec3> T>
void fields(C& c, T& v) {
  all(c, v.x, v.y, v.z);
}
template <class C, Is<DVec3> T>
void fields(C& c, T& v) {
  all(c, v.x, v.y, v.z);
}
template <class C, Is<Quat> T>
void fields(C& c, T& q) {
  all(c, q.x, q.y, q.z, q.w);
}
template <class C, Is<Sym3> T>
void fields(C& c, T& m) {
  all(c, m.xx, m.yy, m.zz, m.xy, m.xz, m.yz);
}
template <class C, class T>
requires(Is<T, Transform> || Is<T, Pose>) void fields(C& c, T& t) { all(c, t.position, t.orientation); }
template <class C, Is<bool[3]> T>
void fields(C& c, T& flags) {
  all(c, flags[0], flags[1], flags[2]);
}
template <class C, class T>
void fields(C& c, std::optional<T>& value) {
  if (c.has(value)) all(c, *value);
}
template <class C, class T>
void fields(C& c, const std::optional<T>& value) {
  if (c.has(value)) all(c, *value);
}

// -------------------------------------------------------------------------------------------------------- definitions

template <class C, Is<Material> T>
void fields(C& c, T& v) {
  auto& [static_friction, dynamic_friction, restitution, rolling, spinning, id] = v;
  all(c, static_friction, dynamic_friction, restitution, rolling, spinning, id);
}
template <class C, Is<MaterialPair> T>
void fields(C& c, T& v) {
  auto& [a, b, static_friction, dynamic_friction, restitution] = v;
  all(c, a, b, static_friction, dynamic_friction, restitution);
}
template <class C, Is<SurfaceRule> T>
void fields(C& c, T& v) {
  auto& [id, material, velocity, one_way] = v;
  all(c, id, material, velocity, one_way);
}
template <class C, Is<SolverOptions> T>
void fields(C& c, T& v) {
  auto& [method, sides, iterations, rows] = v;
  all(c, method, sides, iterations, rows);
}
template <class C, Is<FieldBounds> T>
void fields(C& c, T& v) {
  auto& [low, high] = v;
  all(c, low, high);
}
template <class C, Is<FieldDef> T>
void fields(C& c, T& v) {
  auto& [kind, bounds, layers, velocity, density, drag_coefficient, linear_drag, turbulence,
         turbulence_length, center, strength, radius, falloff, core, axis, normal, offset, points, vectors] = v;
  all(c, kind, bounds, layers, velocity, density, drag_coefficient, linear_drag, turbulence,
      turbulence_length, center, strength, radius, falloff, core, axis, normal, offset);
  if (kind == FieldKind::grid) all(c, points, vectors);
}
template <class C, Is<ExplosionDef> T>
void fields(C& c, T& v) {
  auto& [center, pressure, reference, falloff, radius, occlusion, layers] = v;
  all(c, center, pressure, reference, falloff, radius, occlusion, layers);
}
template <class C, Is<Filter> T>
void fields(C& c, T& v) {
  auto& [layer, collides_with, group] = v;
  all(c, layer, collides_with, group);
}
template <class C, Is<ShapeDef> T>
void fields(C& c, T& v) {
  auto& [geometry, local, density, material, filter, sensor, user_data] = v;
  all(c, geometry, local, density, material, filter, sensor, user_data);
}
template <class C, Is<LockedAxes> T>
void fields(C& c, T& v) {
  auto& [linear, angular] = v;
  all(c, linear, angular);
}
template <class C, Is<MassDef> T>
void fields(C& c, T& v) {
  auto& [mass, center, inertia] = v;
  all(c, mass, center, inertia);
}
template <class C, Is<BodyDef> T>
void fields(C& c, T& v) {
  auto& [type, pose, linear, angular, linear_damping, angular_damping, gravity_scale, continuous, can_sleep,
         sleep_speed, locked, mass, center, inertia, user_data, enabled] = v;
  (void)sleep_speed, (void)enabled;  // commands of their own, SetSleepSpeed and SetEnabled
  all(c, type, pose, linear, angular, linear_damping, angular_damping, gravity_scale, continuous, can_sleep,
      locked, mass, center, inertia, user_data);
}
template <class C, Is<Limits> T>
void fields(C& c, T& v) {
  auto& [low, high] = v;
  all(c, low, high);
}
template <class C, Is<Motor> T>
void fields(C& c, T& v) {
  auto& [velocity, position, force, frequency, damping] = v;
  all(c, velocity, position, force, frequency, damping);
}
template <class C, Is<JointAxisDef> T>
void fields(C& c, T& v) {
  auto& [motion, limits, limit_frequency, limit_damping, motor, stiffness, damping, rest, friction] = v;
  all(c, motion, limits, limit_frequency, limit_damping, motor, stiffness, damping, rest, friction);
}
template <class C, Is<PoseDrive> T>
void fields(C& c, T& v) {
  auto& [position, orientation, linear, angular, frequency, damping, force, torque] = v;
  all(c, position, orientation, linear, angular, frequency, damping, force, torque);
}
template <class C, Is<CouplingTerm> T>
void fields(C& c, T& v) {
  auto& [joint, axis, coefficient] = v;
  all(c, joint, axis, coefficient);
}
template <class C, Is<CouplingDef> T>
void fields(C& c, T& v) {
  auto& [terms, offset] = v;
  all(c, terms, offset);
}
template <class C, class T>
requires(Is<T, std::vector<ShapeDef>> || Is<T, std::vector<CouplingTerm>> || Is<T, std::vector<Vec3>> || Is<T, std::vector<DVec3>> ||
         Is<T, std::vector<std::uint32_t>> || Is<T, std::vector<float>> ||
         Is<T, std::vector<FluidEmitter>> || Is<T, std::vector<FluidRegion>>) void fields(C& c, T& list) {
  c.count(list);
  for (auto& item : list) all(c, item);
}
// Fields that only kinds beyond these five have. Recordings of the five stay short, and older ones can be read.
constexpr bool has_extra_fields(JointKind kind) { return kind > JointKind::distance; }
template <class C, Is<FlatJoint> T>
void fields(C& c, T& v) {
  auto& [kind, a, b, anchor, axis, anchor_b, limits, motor, length, min_length, max_length, stiffness,
         damping, frequency, damping_ratio, break_force, break_torque, collide_connected, axis_b, friction,
         limit_frequency, limit_damping, swing_y, swing_z, ratio, ground_a, ground_b, linear_x, linear_y,
         linear_z, angular_x, angular_y, angular_z, drive, path, path_closed, path_orientation] = v;
  all(c, kind, a, b, anchor, axis, anchor_b, limits, motor, length, min_length, max_length, stiffness,
      damping, frequency, damping_ratio, break_force, break_torque, collide_connected);
  all(c, friction, limit_frequency, limit_damping);
  if (!has_extra_fields(kind)) return;
  all(c, axis_b, swing_y, swing_z, ratio, ground_a, ground_b, linear_x, linear_y, linear_z, angular_x,
      angular_y, angular_z, drive, path, path_closed, path_orientation);
}

// -------------------------------------------------------------------------------------------------------- soft matter

template <class C, class T>
requires(Is<T, std::array<float, 2>> || Is<T, std::array<int, 2>> || Is<T, std::array<int, 3>> ||
         Is<T, std::array<float, 4>> || Is<T, std::array<int, 4>>) void fields(C& c, T& values) {
  for (auto& value : values) all(c, value);
}
template <class C, Is<SoftSettings> T>
void fields(C& c, T& v) {
  auto& [integrator, damping, static_friction, dynamic_friction, filter, user_data, positions, velocities] =
      v;
  all(c, integrator, damping, static_friction, dynamic_friction, filter, user_data, positions, velocities);
}
template <class C, Is<RopeDef> T>
void fields(C& c, T& v) {
  auto& [points, segments, links, radius, density, stretch, bend, settings] = v;
  all(c, points, segments, links, radius, density, stretch, bend, settings);
}
template <class C, Is<ClothGrid> T>
void fields(C& c, T& v) {
  auto& [size, cells] = v;
  all(c, size, cells);
}
template <class C, Is<ClothDef> T>
void fields(C& c, T& v) {
  auto& [grid, vertices, triangles, pose, links, density, stretch, shear, bend, thickness, self_collision, pressure,
         ambient, law, tear, settings] = v;
  (void)pressure, (void)ambient, (void)law, (void)tear;  // later_fields
  all(c, grid, vertices, triangles, pose, links, density, stretch, shear, bend, thickness, self_collision,
      settings);
}
template <class C, Is<SolidBox> T>
void fields(C& c, T& v) {
  auto& [half_extents, cells] = v;
  all(c, half_extents, cells);
}
template <class C, Is<SolidSurface> T>
void fields(C& c, T& v) {
  auto& [vertices, triangles, resolution] = v;
  all(c, vertices, triangles, resolution);
}
template <class C, Is<SolidDef> T>
void fields(C& c, T& v) {
  auto& [box, vertices, tetrahedra, surface, pose, model, density, modulus, ratio, fracture, yield, creep, settings] = v;
  (void)fracture, (void)yield, (void)creep;  // later_fields
  all(c, box, vertices, tetrahedra, surface, pose, model, density, modulus, ratio, settings);
}
// Fields that definitions of the first format did not have. They follow a definition whose kind has kHasLaterFields; the others keep their bytes.
constexpr std::uint8_t kHasLaterFields = 0x80;
bool has_later_fields(const RopeDef&) { return false; }
bool has_later_fields(const ClothDef& def) { return def.pressure.has_value() || def.tear_strain > 0.0f; }
bool has_later_fields(const SolidDef& def) { return def.fracture_stress > 0.0f || def.yield_stress > 0.0f; }
template <class C, Is<RopeDef> T>
void later_fields(C&, T&) {}
template <class C, Is<ClothDef> T>
void later_fields(C& c, T& v) {
  all(c, v.pressure, v.ambient_pressure, v.pressure_law, v.tear_strain);
}
template <class C, Is<SolidDef> T>
void later_fields(C& c, T& v) {
  all(c, v.fracture_stress, v.yield_stress, v.creep_time);
}
// The kind, then the definition.
void fields(FieldWriter& c, const std::shared_ptr<const SoftDef>& def) {
  const bool more = std::visit([](const auto& one) { return has_later_fields(one); }, *def);
  c.number(std::uint8_t(def->index() | (more ? kHasLaterFields : 0)));
  std::visit([&](const auto& one) { fields(c, one); }, *def);
  if (more) std::visit([&](const auto& one) { later_fields(c, one); }, *def);
}
void fields(FieldReader& c, std::shared_ptr<const SoftDef>& def) {
  std::uint8_t kind = 0;
  c.number(kind);
  const bool more = (kind & kHasLaterFields) != 0;
  kind &= std::uint8_t(~kHasLaterFields);
  SoftDef read;
  if (kind == 1) read.emplace<ClothDef>();
  if (kind == 2) read.emplace<SolidDef>();
  if (kind > 2) c.fail();
  std::visit([&](auto& one) { fields(c, one); }, read);
  if (more) std::visit([&](auto& one) { later_fields(c, one); }, read);
  def = std::make_shared<const SoftDef>(std::move(read));
}

// ------------------------------------------------------------------------------------------------------------- fluids

template <class C, class T>
requires(Is<T, std::array<FluidBoundary, 6>> || Is<T, std::array<Vec3, 6>>) void fields(C& c, T& values) {
  for (auto& value : values) all(c, value);
}
template <class C, Is<FluidEmitter> T>
void fields(C& c, T& v) {
  auto& [position, radius, density, temperature, velocity, start, end, fuel] = v;
  all(c, position, radius, density, temperature);
  // A byte tells which follow: 1 a velocity, 2 fuel, which came later.
  auto parts = std::uint8_t((velocity ? 1 : 0) | (fuel != 0.0f ? 2 : 0));
  c.number(parts);
  if constexpr (!std::is_const_v<T>) {
    if (parts > 3) c.fail();
    if ((parts & 1) != 0) velocity.emplace();
  }
  if ((parts & 1) != 0) all(c, *velocity);
  all(c, start, end);
  if ((parts & 2) != 0) all(c, fuel);
}
template <class C, Is<Combustion> T>
void fields(C& c, T& v) {
  auto& [ignition_temperature, burn_rate, heat_release, heat_capacity, smoke_yield] = v;
  all(c, ignition_temperature, burn_rate, heat_release, heat_capacity, smoke_yield);
}
template <class C, Is<AdaptiveDomain> T>
void fields(C& c, T& v) {
  auto& [margin, threshold] = v;
  all(c, margin, threshold);
}
template <class C, Is<TaylorGreen> T>
void fields(C& c, T& v) {
  auto& [amplitude, wave_number] = v;
  all(c, amplitude, wave_number);
}
template <class C, Is<GasFields> T>
void fields(C& c, T& v) {
  auto& [x, y, z, density, temperature, pressure, fuel] = v;
  all(c, x, y, z, density, temperature, pressure);
}
template <class C, Is<GasDef> T>
void fields(C& c, T& v) {
  auto& [lower, upper, cells, density, viscosity, buoyancy, vorticity, ambient, advection, sides, walls,
         initial, vortices, emitters, state, user_data, combustion, pose, linear, angular, adaptive] = v;
  all(c, lower, upper, cells, density, viscosity, buoyancy, vorticity, ambient, advection, sides, walls,
      initial, vortices, emitters, state, user_data);
}
// Combustion came later: the definition of a gas without it has the bytes that it always had.
constexpr std::uint8_t kBurns = 0x80;
// Nor has one that stands in the axes of the world the bytes of a pose.
constexpr std::uint8_t kHasFrame = 0x40;
// Nor has one of which all cells are computed.
constexpr std::uint8_t kAdapts = 0x20;
bool has_frame(const FluidDef& def) {
  return std::visit(
      [](const auto& one) {
        return one.pose != Pose{} || one.linear_velocity != Vec3{} || one.angular_velocity != Vec3{};
      },
      def);
}
template <class C, class T>
void frame_fields(C& c, T& def) {
  std::visit(
      [&](auto& one) {
        all(c, one.pose.position, one.pose.orientation, one.linear_velocity, one.angular_velocity);
      },
      def);
}
bool burns(const FluidDef& def) {
  const auto* const gas = std::get_if<GasDef>(&def);
  return gas != nullptr && gas->combustion.has_value();
}
bool adapts(const FluidDef& def) {
  const auto* const gas = std::get_if<GasDef>(&def);
  return gas != nullptr && gas->adaptive_domain.has_value();
}
template <class C, class T>
void combustion_fields(C& c, T& gas) {
  all(c, *gas.combustion);
  if (gas.fields) all(c, gas.fields->fuel);
}
template <class C, Is<FluidRegion> T>
void fields(C& c, T& v) {
  auto& [lower, upper] = v;
  all(c, lower, upper);
}
template <class C, Is<LiquidParticles> T>
void fields(C& c, T& v) {
  auto& [positions, velocities, volumes, affine] = v;
  all(c, positions, velocities, volumes, affine);
}
template <class C, Is<LiquidDef> T>
void fields(C& c, T& v) {
  auto& [lower, upper, cell_size, fill, density, viscosity, tension, sides, walls, initial, emitters, particles, user_data, pose, linear, angular] = v;
  all(c, lower, upper, cell_size, fill, density, viscosity, tension, sides, walls, initial, emitters, particles, user_data);
}
// The kind, then the definition.
void fields(FieldWriter& c, const std::shared_ptr<const FluidDef>& def) {
  c.number(std::uint8_t(def->index() | (burns(*def) ? kBurns : 0) | (has_frame(*def) ? kHasFrame : 0) |
                        (adapts(*def) ? kAdapts : 0)));
  std::visit([&](const auto& one) { fields(c, one); }, *def);
  if (burns(*def)) combustion_fields(c, std::get<GasDef>(*def));
  if (has_frame(*def)) frame_fields(c, *def);
  if (adapts(*def)) all(c, *std::get<GasDef>(*def).adaptive_domain);
}
void fields(FieldReader& c, std::shared_ptr<const FluidDef>& def) {
  std::uint8_t kind = 0;
  c.number(kind);
  const bool is_placed = (kind & kHasFrame) != 0;
  const bool is_adaptive = (kind & kAdapts) != 0;
  kind = std::uint8_t(kind & ~(kHasFrame | kAdapts));
  const bool has_combustion = kind == kBurns;
  if (has_combustion) kind = 0;
  if (is_adaptive && kind != 0) c.fail(), kind = 0;
  FluidDef read;
  if (kind == 1) read.emplace<LiquidDef>();
  if (kind >= std::variant_size_v<FluidDef>) c.fail();
  std::visit([&](auto& one) { fields(c, one); }, read);
  if (has_combustion) {
    GasDef& gas = std::get<GasDef>(read);
    gas.combustion.emplace();
    combustion_fields(c, gas);
  }
  if (is_placed) frame_fields(c, read);
  if (is_adaptive) {
    std::optional<AdaptiveDomain>& domain = std::get<GasDef>(read).adaptive_domain;
    domain.emplace();
    all(c, *domain);
  }
  def = std::make_shared<const FluidDef>(std::move(read));
}

// ----------------------------------------------------------------------------------------------------------- commands

template <class T, class... Of>
concept IsOneOf = (Is<T, Of> || ...);

template <class C, class T>
requires IsOneOf<T, RemoveBody, RemoveShape, AddJoint, RemoveJoint, SetGravity, SetMaterialPair,
                 SetSurfaceRule, SetSleeping, SetSubsteps, AddField, RemoveField, Explode, AddSoft,
                 RemoveSoft, AddFluid, RemoveFluid, SetSleepShare, Step, AddCoupling, RemoveCoupling>
void fields(C& c, T& v) {
  auto& [only] = v;
  all(c, only);
}
template <class C, class T>
requires IsOneOf<T, AddBody, AddShape, SetPose, SetType, SetGravityScale, SetMaterial, SetFilter, SetMotor,
                 SetAwake, SetField, SetSleepSpeed, SetCombineRules, SetDrive, SetJointEnabled, SetSolver, ReleaseSoft,
                 SetEmitters, SetMass, SetDensity, SetLockedAxes, SetContinuous, SetCanSleep, SetSensor, SetBodyUserData, ReleasePoints,
                  SetShapeUserData, SetEnabled, SetFluidPose>
void fields(C& c, T& v) {
  auto& [first, second] = v;
  all(c, first, second);
}
template <class C, Is<SoftPoint> T>
void fields(C& c, T& v) {
  auto& [vertices, weights] = v;
  all(c, vertices, weights);
}
template <class C, Is<SetVertexLimits> T>
void fields(C& c, T& v) {
  auto& [soft, targets, distances, normals, backstops] = v;
  all(c, soft, targets, distances, normals, backstops);
}
template <class C, Is<SetMotion> T>
void fields(C& c, T& v) {
  auto& [integrator, springs, time, tolerance, max_impacts] = v;
  all(c, integrator, springs, time, tolerance, max_impacts);
}
template <class C, class T>
requires IsOneOf<T, SetVelocity, MoveKinematic, SetDamping, AddForce, AddImpulse, SetJointAxis, AttachSoft, AttachPoint,
                 SetVertices, SetShape, SetBreakLoad, SetPairIgnored, SetFluidVelocity>
void fields(C& c, T& v) {
  auto& [first, second, third] = v;
  all(c, first, second, third);
}

template <class C, class... Fields>
void all(C& c, Fields&... values) {
  (fields(c, values), ...);
}

// The n-th alternative of a variant, default-constructed.
template <std::size_t n = 0>
bool make_alternative(std::size_t index, Command& command) {
  if constexpr (n < std::variant_size_v<Command>) {
    if (index != n) return make_alternative<n + 1>(index, command);
    command.emplace<n>();
    return true;
  } else {
    return false;
  }
}

}  // namespace

void write_command(ByteWriter& out, const Command& command) {
  static_assert(std::variant_size_v<Command> < 256, "the number of a command is one byte");
  out.put(std::uint8_t(command.index()));
  FieldWriter writer(out);
  std::visit([&](const auto& c) { fields(writer, c); }, command);
}

Command read_command(ByteReader& in, const GeometryTable& geometry, std::uint16_t world_number) {
  Command command = Step{};
  if (!make_alternative(in.get<std::uint8_t>(), command)) in.fail();
  FieldReader reader(in, geometry, world_number);
  std::visit([&](auto& c) { fields(reader, c); }, command);
  return command;
}

void write_soft_def(ByteWriter& out, const SoftDef& def) {
  FieldWriter writer(out);
  fields(writer, std::make_shared<const SoftDef>(def));
}

std::shared_ptr<const SoftDef> read_soft_def(ByteReader& in) {
  const GeometryTable none;
  FieldReader reader(in, none, 0);
  std::shared_ptr<const SoftDef> def;
  fields(reader, def);
  return def;
}

void write_fluid_def(ByteWriter& out, const FluidDef& def) {
  FieldWriter writer(out);
  fields(writer, std::make_shared<const FluidDef>(def));
}

std::shared_ptr<const FluidDef> read_fluid_def(ByteReader& in) {
  const GeometryTable none;
  FieldReader reader(in, none, 0);
  std::shared_ptr<const FluidDef> def;
  fields(reader, def);
  return def;
}

void for_each_shape(const Command& command, FunctionRef<void(const AnyShape&)> fn) {
  if (const auto* body = std::get_if<AddBody>(&command)) {
    for (const ShapeDef& shape : body->shapes) fn(shape.geometry);
  }
  if (const auto* shape = std::get_if<AddShape>(&command)) fn(shape->def.geometry);
  if (const auto* set = std::get_if<SetShape>(&command); set != nullptr && set->geometry) fn(*set->geometry);
}

}  // namespace gyre
