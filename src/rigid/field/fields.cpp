#include "rigid/field/fields.h"

#include "geometry/mass/submerged.h"
#include "math/dense.h"
#include "solver/motion/motion_block.h"

namespace gyre {

namespace {

BodyState state_of(const RigidWorld& w, std::uint32_t body) {
  const BodyMotion& motion = w.bodies.motion[body];
  return {w.bodies.poses[body].center + motion.delta_position, normalized(to_double(w.bodies.orientations[body])),
          DVec3(motion.linear_velocity), DVec3(motion.angular_velocity)};
}

// Mass and world inertia as a matrix.
Mat6 mass_matrix(const BodyMass& mass, const BodyState& state) {
  const Sym3 inertia = rotate_inertia(to_float(state.orientation), mass.inertia);
  Mat6 out;
  for (int i = 0; i < 3; ++i) out.m[i][i] = double(mass.mass);
  out.m[3][3] = double(inertia.xx), out.m[4][4] = double(inertia.yy), out.m[5][5] = double(inertia.zz);
  out.m[3][4] = out.m[4][3] = double(inertia.xy);
  out.m[3][5] = out.m[5][3] = double(inertia.xz);
  out.m[4][5] = out.m[5][4] = double(inertia.yz);
  return out;
}

// Removes the locked axes from the system.
void lock(const BodyFlags& flags, Mat6& matrix, Vec6& right) {
  const std::uint32_t locked = std::uint32_t(flags.locked_linear) | std::uint32_t(flags.locked_angular) << 3;
  if (locked == 0) return;
  for (int i = 0; i < 6; ++i) {
    if ((locked >> i & 1u) == 0) continue;
    for (int j = 0; j < 6; ++j) matrix.m[i][j] = matrix.m[j][i] = 0.0;
    matrix.m[i][i] = 1.0;
    right.v[i] = 0.0;
  }
}

void add_radial_forces(const RigidWorld& w, const FieldBody& from, const BodyState& state, Vec6& force,
                       Mat6& stiffness) {
  const double mass = double(w.bodies.masses[from.body].mass);
  for (const std::uint32_t slot : from.fields) {
    const FieldRecord& field = w.fields[slot];
    if (field.kind == FieldKind::grid)
      add(force, make_vec6(mass * grid_acceleration_at(w, slot, state.center), {}));
    if (field.kind != FieldKind::radial) continue;
    const RadialForce radial = radial_force_at(field, state.center);
    add(force, make_vec6(mass * radial.acceleration, {}));
    for (int i = 0; i < 3; ++i) stiffness.m[i][i] += mass * radial.stiffness;
  }
}

// The component of gravity into a buoyant medium; 0 or less: no buoyancy.
double weight_along(const RigidWorld& w, const FieldRecord& field) {
  return field.kind == FieldKind::buoyancy ? -double(dot(w.settings.gravity, field.normal)) : 0.0;
}

void add_buoyancy_forces(const RigidWorld& w, const FieldBody& from, const BodyState& state, Vec6& force,
                         Mat6& stiffness) {
  for (const std::uint32_t slot : from.fields) {
    const double gravity = weight_along(w, w.fields[slot]);
    if (gravity > 0.0) add_buoyancy(w, w.fields[slot], from.body, state, gravity, force, stiffness);
  }
}

// Buoyancy and its torque at the end of the sub-step: v = v* + h / m F(x + h v) along gravity. The right side falls with v,
// so there is one root. It is found by regula falsi (the Illinois variant: M. Dowell, P. Jarratt, 1971).
void add_implicit_buoyancy(const RigidWorld& w, const FieldBody& from, const BodyState& state, double h,
                           Vec6& force, Mat6& stiffness) {
  const DVec3 gravity(w.settings.gravity);
  const DVec3 up = gravity / -length(gravity);
  const double compliance = h / double(w.bodies.masses[from.body].mass), start = dot(state.velocity, up);
  const auto buoyancy_at = [&](double speed, Vec6& buoyancy, Mat6& stiff) {
    BodyState predicted = state;
    predicted.center += h * state.velocity + (h * (speed - start)) * up;
    add_buoyancy_forces(w, from, predicted, buoyancy, stiff);
    return speed - start - compliance * dot(buoyancy.linear(), up);
  };
  double low = start;
  Vec6 buoyancy;
  Mat6 stiff;
  double low_value = buoyancy_at(low, buoyancy, stiff);
  double high = low - low_value, speed = low;  // the buoyancy is largest where the body rises least
  if (low_value < 0.0) {
    double high_value = buoyancy_at(high, buoyancy = {}, stiff = {});
    speed = high;
    for (int i = 0; i < 40 && high - low > 1.0e-9 * (absolute(high) + absolute(low)); ++i) {
      speed = low - low_value * (high - low) / (high_value - low_value);
      const double value = buoyancy_at(speed, buoyancy = {}, stiff = {});
      if (value > 0.0) {
        high = speed, high_value = value;
        low_value *= 0.5;
      } else {
        low = speed, low_value = value;
        high_value *= 0.5;
      }
    }
  }
  add(force, buoyancy);
  // The buoyancy is implicit along gravity, so only the rotational stiffness remains.
  for (int i = 3; i < 6; ++i) {
    for (int j = 3; j < 6; ++j) stiffness.m[i][j] += stiff.m[i][j];
  }
}

// The share of h^2 K that is added to the mass. It grows if (w h)^2 of the stiffest motion exceeds 1.
double filter_of(const Mat6& mass, const Mat6& stiffness, double h) {
  double max_ratio = 0.0;
  for (int i = 0; i < 6; ++i) {
    if (mass.m[i][i] > 0.0) max_ratio = max(max_ratio, h * h * stiffness.m[i][i] / mass.m[i][i]);
  }
  return 0.25 + 4.0 * max_ratio / (1.0 + max_ratio);
}

// The drag on the body if it were at rest.
Vec6 stream_drive(const RigidWorld& w, const FieldBody& from, const BodyState& state, double time) {
  Vec6 sum;
  for (std::size_t i = 0; i < from.fields.size(); ++i) {
    const FieldRecord& field = w.fields[from.fields[i]];
    if (field.is_medium()) add(sum, from.drags[i] * stream_at(field, state.center, time));
  }
  return sum;
}

// Magnetic fields turn the velocity and keep its size: a rotation against B, exact for a uniform field.
DVec3 turn_in_magnetic_fields(const RigidWorld& w, const FieldBody& from, const BodyState& state, double h,
                              DVec3 velocity) {
  DVec3 rate;
  for (const std::uint32_t slot : from.fields)
    if (w.fields[slot].is_magnetic()) rate += magnetic_rate_at(w.fields[slot], state.center);
  if (rate == DVec3{} || w.bodies.flags[from.body].locked_linear != 0) return velocity;
  return rotate(exponential_map(-h * rate), velocity);
}

void apply_fields(RigidWorld& w, const FieldBody& from, double h) {
  BodyMotion& motion = w.bodies.motion[from.body];
  const BodyState state = state_of(w, from.body);
  Vec6 force;
  Mat6 stiffness;
  add_radial_forces(w, from, state, force, stiffness);
  if (from.has_implicit_buoyancy) {
    add_implicit_buoyancy(w, from, state, h, force, stiffness);
  } else {
    add_buoyancy_forces(w, from, state, force, stiffness);
  }
  Mat6 matrix = mass_matrix(w.bodies.masses[from.body], state);
  const double filter = filter_of(matrix, stiffness, h) * h * h;
  add_scaled(matrix, filter, stiffness);
  const Vec6 velocity_change =
      make_vec6(state.velocity - DVec3(from.linear_before), state.spin - DVec3(from.angular_before));
  const Vec6 stiffness_force = stiffness * velocity_change;
  Vec6 right;
  for (int i = 0; i < 6; ++i) right.v[i] = h * force.v[i] - filter * stiffness_force.v[i];
  if (from.has_drag) {
    add_scaled(matrix, h, from.drag);
    const Vec6 drag_force = from.drag * make_vec6(state.velocity, state.spin);
    const Vec6 drive = stream_drive(w, from, state, w.now + 0.5 * double(w.settings.last_step));
    for (int i = 0; i < 6; ++i) right.v[i] += h * (drive.v[i] - drag_force.v[i]);
  }
  lock(w.bodies.flags[from.body], matrix, right);
  // Masses and moments may differ by many orders, so a pivot is compared with its own row only.
  solve_ldlt(factor_ldlt(matrix.m, 1.0e-300), right.v);
  // Radial forces may grow with distance. The speed limits hold for their results, too.
  const DVec3 turned = turn_in_magnetic_fields(w, from, state, h, state.velocity + right.linear());
  const Vec3 v = to_float(clamp_length(turned, double(kMaxSpeed)));
  const Vec3 a = to_float(clamp_length(state.spin + right.angular(), double(kMaxSpin)));
  if (!is_finite(v) || !is_finite(a)) return;
  motion.linear_velocity = v + Vec3{};
  motion.angular_velocity = a + Vec3{};
}

// True if the fully submerged body would oscillate with w h > 0.3 about a cut across its thinnest part.
bool needs_implicit_buoyancy(const RigidWorld& w, const FieldBody& from, double h) {
  constexpr double kStiff = 0.1;  // (w h)^2 from which the implicit form pays
  double buoyancy = 0.0;
  for (const std::uint32_t slot : from.fields) {
    const FieldRecord& field = w.fields[slot];
    const double gravity = weight_along(w, field);
    if (!(gravity > 0.0)) continue;
    for (const ShapeId id : w.bodies.shapes[from.body]) {
      if (acts_on_shape(w, field, id.index))
        buoyancy += double(field.density) * gravity * volume_of(w.shapes.colliders[id.index].shape);
    }
  }
  const BodyMass& mass = w.bodies.masses[from.body];
  return h * h * buoyancy > kStiff * double(mass.mass) * 2.0 * double(mass.size);
}

void prepare_fields(RigidWorld& w, FieldBody& from, double h) {
  from.has_implicit_buoyancy = needs_implicit_buoyancy(w, from, h);
  const BodyState state = state_of(w, from.body);
  FieldRest& rest = w.field_rest[from.body];
  rest = {w.bodies.motion[from.body].linear_velocity, w.bodies.motion[from.body].angular_velocity,
          from.unconstrained ? kFieldsOnly : kFieldsAndConstraints, 0};
  const double time = w.now + 0.5 * double(w.settings.last_step);
  for (std::size_t i = 0; i < from.fields.size(); ++i) {
    const FieldRecord& field = w.fields[from.fields[i]];
    from.drags[i] = {};
    if (!field.is_medium()) continue;
    if (field.turbulence != 0.0f) rest.is_unsteady = 1;
    add_drag(w, field, from.body, state, stream_at(field, state.center, time), from.drags[i]);
    add_scaled(from.drag, 1.0, from.drags[i]);
    from.has_drag = true;
  }
}

// Calls fn(world, body, h) for the bodies of some blocks.
template <class Fn>
void for_bodies(const FieldSolve& solve, int begin, int end, Fn&& fn) {
  const std::size_t last = min(std::size_t(end) * kFieldBodiesPerBlock, solve.bodies.size());
  for (std::size_t i = std::size_t(begin) * kFieldBodiesPerBlock; i < last; ++i)
    fn(*solve.world, solve.bodies[i], solve.h);
}

}  // namespace

Vec6 force_of_fields(const RigidWorld& w, std::uint32_t body, std::span<const std::uint32_t> fields,
                     const BodyState& state, double time) {
  Vec6 force;
  Mat6 stiffness;
  for (const std::uint32_t slot : fields) {
    const FieldRecord& field = w.fields[slot];
    if (field.kind == FieldKind::radial)
      add(force,
          make_vec6(double(w.bodies.masses[body].mass) * radial_force_at(field, state.center).acceleration,
                    {}));
    if (field.kind == FieldKind::grid)
      add(force, make_vec6(double(w.bodies.masses[body].mass) * grid_acceleration_at(w, slot, state.center), {}));
    if (field.is_magnetic())
      add(force, make_vec6(double(w.bodies.masses[body].mass) *
                               cross(state.velocity, magnetic_rate_at(field, state.center)),
                           {}));
    if (const double gravity = weight_along(w, field); gravity > 0.0)
      add_buoyancy(w, field, body, state, gravity, force, stiffness);
    if (!field.is_medium()) continue;
    const Vec6 stream = stream_at(field, state.center, time);
    Vec6 slip = stream;
    const Vec6 velocity = make_vec6(state.velocity, state.spin);
    for (int i = 0; i < 6; ++i) slip.v[i] -= velocity.v[i];
    Mat6 drag;
    add_drag(w, field, body, state, stream, drag);
    add(force, drag * slip);
  }
  return force;
}

FieldSolve find_field_bodies(RigidWorld& w, std::span<const std::uint32_t> bodies, float h, Arena& arena,
                             bool free) {
  FieldSolve solve{&w, {}, h};
  if (w.field_rest.empty()) return solve;
  const auto acts = [&](std::uint32_t slot, std::uint32_t body) {
    return w.fields[slot].is_live() && acts_on(w, w.fields[slot], body, w.bodies.poses[body].center);
  };
  const auto is_candidate = [&](std::uint32_t body) {
    return is_movable(w.bodies.flags[body]) &&
           (free || w.bodies.flags[body].constraint_use != kNotConstrained);
  };
  const std::uint32_t slots = std::uint32_t(w.fields.size());
  std::size_t count = 0, links = 0;
  for (const std::uint32_t body : bodies) {
    std::size_t acting = 0;
    if (is_candidate(body)) {
      for (std::uint32_t slot = 0; slot < slots; ++slot) acting += acts(slot, body) ? 1 : 0;
    }
    links += acting;
    count += acting > 0 ? 1 : 0;
  }
  const std::span<FieldBody> out = arena.make<FieldBody>(count);
  const std::span<std::uint32_t> list = arena.make<std::uint32_t>(links);
  const std::span<Mat6> drags = arena.make<Mat6>(links);
  count = links = 0;
  for (const std::uint32_t body : bodies) {
    if (!is_candidate(body)) continue;
    const std::size_t first = links;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      if (acts(slot, body)) list[links++] = slot;
    }
    if (links == first) continue;
    out[count] = {};
    out[count].body = body;
    out[count].unconstrained = w.bodies.flags[body].constraint_use == 0;
    out[count].drags = drags.subspan(first, links - first);
    out[count++].fields = list.subspan(first, links - first);
  }
  for (const FieldBody& made : out) {
    w.bodies.flags[made.body].constraint_use = kPoseRead;
    w.field_rest[made.body].acts = made.unconstrained ? kFieldsOnly : kFieldsAndConstraints;
  }
  solve.bodies = out;
  return solve;
}

int FieldSolve::blocks() const {
  return (int(bodies.size()) + kFieldBodiesPerBlock - 1) / kFieldBodiesPerBlock;
}

void prepare_field_bodies(const FieldSolve& fields, int begin, int end) {
  for_bodies(fields, begin, end,
             [](RigidWorld& w, FieldBody& body, float h) { prepare_fields(w, body, double(h)); });
}
void record_field_velocities(const FieldSolve& fields, int begin, int end) {
  for_bodies(fields, begin, end, [](const RigidWorld& w, FieldBody& body, float) {
    body.linear_before = w.bodies.motion[body.body].linear_velocity;
    body.angular_before = w.bodies.motion[body.body].angular_velocity;
  });
}
void apply_field_forces(const FieldSolve& fields, int begin, int end) {
  for_bodies(fields, begin, end,
             [](RigidWorld& w, const FieldBody& body, float h) { apply_fields(w, body, double(h)); });
}

}  // namespace gyre
