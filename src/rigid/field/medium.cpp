#include "rigid/field/medium.h"

#include "geometry/mass/submerged.h"
#include "geometry/mass/surface_patches.h"
#include "math/trig.h"

namespace gyre {

namespace {

// -------------------------------------------------------------------------------------------------------------- streams

// A wave of gusts. Its velocity is at a right angle to its direction, so the flow is free of divergence.
struct Gust {
  DVec3 wave;  // direction
  DVec3 sway;
  double phase;
  double share;   // of the wave number
  double weight;  // of the square of the speed
};
// Three sizes with energies as the 2/3 power of the size (A. N. Kolmogorov, 1941), two waves each; weights sum to 1.
constexpr double kLargeWave = 0.24657, kMiddleWave = 0.15533, kSmallWave = 0.09810;
constexpr Gust kGusts[6] = {
    {{0.80, 0.00, 0.60}, {-0.36, 0.80, 0.48}, 0.3, 1.0, kLargeWave},
    {{0.60, 0.00, -0.80}, {0.48, 0.80, 0.36}, 2.1, 1.0, kLargeWave},
    {{0.64, 0.60, 0.48}, {0.60, 0.00, -0.80}, 4.4, 2.0, kMiddleWave},
    {{0.48, -0.80, 0.36}, {0.64, 0.60, 0.48}, 1.2, 2.0, kMiddleWave},
    {{0.36, 0.48, 0.80}, {0.80, -0.60, 0.00}, 5.7, 4.0, kSmallWave},
    {{-0.28, 0.96, 0.00}, {0.00, 0.00, 1.00}, 3.3, 4.0, kSmallWave},
};

DVec3 gusts_at(const FieldRecord& field, DVec3 position, double time) {
  const DVec3 mean(field.velocity);
  const double speed = length(mean);
  if (field.turbulence == 0.0f || speed == 0.0) return {};
  const DVec3 drifting = position - time * mean;
  const double number = 2.0 * kPiDouble / double(field.turbulence_length);
  DVec3 sum;
  for (const Gust& gust : kGusts) {
    const double s = sin_cos(number * gust.share * dot(gust.wave, drifting) + gust.phase).sin;
    // A wave's mean square is half its amplitude's square.
    sum += std::sqrt(2.0 * gust.weight) * s * gust.sway;
  }
  return double(field.turbulence) * speed * sum;
}

Vec6 vortex_at(const FieldRecord& field, DVec3 position) {
  const DVec3 axis(field.axis), from = position - field.center;
  const DVec3 out = from - dot(axis, from) * axis;
  const double radius = double(field.radius), rate = double(field.strength) / radius;
  const double square_ratio = length_squared(out) / (radius * radius);
  if (square_ratio <= 1.0) return make_vec6(rate * cross(axis, out), rate * axis);
  return make_vec6((rate / square_ratio) * cross(axis, out), {});
}

// ----------------------------------------------------------------------------------------------------------------- drag

// Sums of c, c r and c r r' over elements of the surface, whose force is c w.
struct DragSum {
  double whole = 0.0;
  DVec3 first;
  SecondMoments second;

  void add(double c, DVec3 r) {
    whole += c;
    first += c * r;
    add_product(second, c, r);
  }
  void add_scaled(double scale, const DragSum& more) {
    whole += scale * more.whole;
    first += scale * more.first;
    second.xx += scale * more.second.xx, second.yy += scale * more.second.yy,
        second.zz += scale * more.second.zz;
    second.xy += scale * more.second.xy, second.xz += scale * more.second.xz,
        second.yz += scale * more.second.yz;
  }
};

// Adds the sum of c J'J with J (v, a) = v + a x r.
void add_drag_matrix(Mat6& to, const DragSum& s) {
  for (int i = 0; i < 3; ++i) to.m[i][i] += s.whole;
  // The cross product r x as a matrix, below the diagonal block; its transpose above.
  const DVec3 r = s.first;
  const double skew[3][3] = {{0.0, -r.z, r.y}, {r.z, 0.0, -r.x}, {-r.y, r.x, 0.0}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      to.m[3 + i][j] += skew[i][j];
      to.m[j][3 + i] += skew[i][j];
    }
  }
  const SecondMoments& q = s.second;
  to.m[3][3] += q.yy + q.zz, to.m[4][4] += q.xx + q.zz, to.m[5][5] += q.xx + q.yy;
  to.m[3][4] -= q.xy, to.m[4][3] -= q.xy;
  to.m[3][5] -= q.xz, to.m[5][3] -= q.xz;
  to.m[4][5] -= q.yz, to.m[5][4] -= q.yz;
}

bool is_round(ShapeKind kind) {
  return kind == ShapeKind::sphere || kind == ShapeKind::capsule || kind == ShapeKind::cylinder ||
         kind == ShapeKind::cone;
}

// The frame of a shape in world axes, about the centre of mass of its body.
struct ShapeState {
  DQuat orientation;  // world_from_shape
  DVec3 offset;  // of the shape's origin from the centre of mass, world axes
};
ShapeState state_of(const RigidWorld& w, std::uint32_t body, std::uint32_t shape, const BodyState& state) {
  const Transform& local = w.shapes.body_from_shape[shape];
  return {state.orientation * to_double(local.orientation),
          rotate(state.orientation, DVec3(local.position) - DVec3(w.bodies.masses[body].center))};
}

// The surface plane of a field in the frame of a shape.
struct ShapePlane {
  DVec3 normal;
  double level;
};
ShapePlane plane_of(const FieldRecord& field, const BodyState& body, const ShapeState& shape) {
  if (field.kind != FieldKind::buoyancy) return {{0, 1, 0}, double(kUnbounded)};
  const DVec3 normal(field.normal);
  return {rotate_inverse(shape.orientation, normal),
          field.offset - dot(normal, body.center) - dot(normal, shape.offset)};
}

// The drag on the surface of one shape, for the present velocity of the medium relative to it.
DragSum shape_drag(const Shape& shape, const ShapeState& at, const ShapePlane& plane, const Vec6& against) {
  DragSum sum;
  double facing_area = 0.0;  // of the whole surface, for round shapes
  const DVec3 wind = rotate_inverse(at.orientation, against.linear() + cross(against.angular(), at.offset));
  const double speed = length(wind);
  for_each_patch(shape, plane.normal, plane.level, [&](const SurfacePatch& patch) {
    const DVec3 r = at.offset + rotate(at.orientation, patch.position);
    const DVec3 flow = against.linear() + cross(against.angular(), r);
    const double c = max(-dot(flow, rotate(at.orientation, patch.normal)), 0.0) * patch.area;
    if (c > 0.0) sum.add(c, r);
  });
  if (!is_round(shape.kind) || speed == 0.0) return sum;
  for_each_patch(shape, {0, 1, 0}, double(kUnbounded), [&](const SurfacePatch& patch) {
    facing_area += max(-dot(wind, patch.normal), 0.0) * patch.area;
  });
  if (!(facing_area > 0.0)) return sum;
  DragSum exact;
  exact.add_scaled(projected_area(shape, wind / speed) * speed / facing_area, sum);
  return exact;
}

// The share of the volume of the body below the surface of the field.
double submerged_share(const RigidWorld& w, const FieldRecord& field, std::uint32_t body,
                       const BodyState& state) {
  double below = 0.0, whole = 0.0;
  for (const ShapeId id : w.bodies.shapes[body]) {
    if (!acts_on_shape(w, field, id.index)) continue;
    const Shape& shape = w.shapes.colliders[id.index].shape;
    const ShapePlane plane = plane_of(field, state, state_of(w, body, id.index, state));
    below += submerged_part(shape, plane.normal, plane.level).volume;
    whole += volume_of(shape);
  }
  return whole > 0.0 ? below / whole : 0.0;
}

void add_linear_drag(const RigidWorld& w, std::uint32_t body, const BodyState& state, double rate, Mat6& to) {
  const BodyMass& mass = w.bodies.masses[body];
  const Sym3 inertia = rotate_inertia(to_float(state.orientation), mass.inertia);
  for (int i = 0; i < 3; ++i) to.m[i][i] += rate * double(mass.mass);
  const double rows[3][3] = {{double(inertia.xx), double(inertia.xy), double(inertia.xz)},
                             {double(inertia.xy), double(inertia.yy), double(inertia.yz)},
                             {double(inertia.xz), double(inertia.yz), double(inertia.zz)}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) to.m[3 + i][3 + j] += rate * rows[i][j];
  }
}

}  // namespace

Vec6 operator*(const Mat6& a, const Vec6& b) {
  Vec6 out;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) out.v[i] += a.m[i][j] * b.v[j];
  }
  return out;
}
void add(Vec6& to, const Vec6& more) {
  for (int i = 0; i < 6; ++i) to.v[i] += more.v[i];
}
void add_scaled(Mat6& to, double scale, const Mat6& more) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) to.m[i][j] += scale * more.m[i][j];
  }
}
void add_row(Mat6& to, double weight, const Vec6& row) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) to.m[i][j] += weight * row.v[i] * row.v[j];
  }
}

bool acts_on_shape(const RigidWorld& w, const FieldRecord& field, std::uint32_t shape) {
  const Proxy& proxy = w.shapes.proxies[shape];
  return !proxy.sensor && (proxy.filter.layer & field.layers) != 0;
}

bool acts_on(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, DVec3 center) {
  if (field.has_bounds != 0) {
    const DVec3 low = field.low, high = field.high;
    if (!(center.x >= low.x && center.y >= low.y && center.z >= low.z && center.x <= high.x &&
          center.y <= high.y && center.z <= high.z)) {
      return false;
    }
  }
  const auto& shapes = w.bodies.shapes[body];
  if (shapes.empty()) return true;
  if (field.kind == FieldKind::buoyancy) {
    // The body certainly stays above the surface in this step.
    const double height = dot(DVec3(field.normal), center) - field.offset,
                 step = double(w.settings.last_step);
    const double max_displacement = step * (double(length(w.bodies.motion[body].linear_velocity)) +
                                            step * double(length(w.settings.gravity)));
    if (height > double(w.bodies.masses[body].bounding_radius) + max_displacement) return false;
  }
  for (const ShapeId id : shapes) {
    if (acts_on_shape(w, field, id.index)) return true;
  }
  return false;
}

Vec6 stream_at(const FieldRecord& field, DVec3 position, double time) {
  Vec6 out = make_vec6(DVec3(field.velocity), {});
  if (field.kind == FieldKind::wind) add(out, make_vec6(gusts_at(field, position, time), {}));
  if (field.kind == FieldKind::vortex) add(out, vortex_at(field, position));
  return out;
}

DVec3 magnetic_rate_at(const FieldRecord& field, DVec3 position) {
  const DVec3 axis(field.axis);
  const double strength = double(field.strength);
  if (field.kind == FieldKind::magnetic) return strength * axis;
  const DVec3 from = position - field.center;
  const double square = length_squared(from) + double(field.core) * double(field.core);
  if (!(square > 0.0)) return {};
  const double radius = double(field.radius);
  const double share = radius * radius * radius / (square * std::sqrt(square));
  return (strength * share) * ((3.0 * dot(axis, from) / square) * from - axis);
}

DVec3 grid_acceleration_at(const RigidWorld& w, std::uint32_t slot, DVec3 position) {
  const FieldRecord& field = w.fields[slot];
  const FieldGrid& grid = w.field_grids[slot];
  const double at[3] = {position.x - field.low.x, position.y - field.low.y, position.z - field.low.z};
  const double size[3] = {field.high.x - field.low.x, field.high.y - field.low.y, field.high.z - field.low.z};
  std::size_t cell[3];
  double share[3];
  for (int i = 0; i < 3; ++i) {
    const double cells = double(grid.points[i] - 1);
    const double place = size[i] > 0.0 ? clamp(at[i] / size[i] * cells, 0.0, cells) : 0.0;
    const double first = min(std::floor(place), cells - 1.0);
    cell[i] = std::size_t(first);
    share[i] = place - first;
  }
  DVec3 sum;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::size_t index[3];
    for (int i = 0; i < 3; ++i) {
      const bool high = (corner >> i & 1) != 0;
      weight *= high ? share[i] : 1.0 - share[i];
      index[i] = cell[i] + (high ? 1 : 0);
    }
    const std::size_t row = index[2] * std::size_t(grid.points[1]) + index[1];
    sum += weight * DVec3(w.field_vectors[grid.first + row * std::size_t(grid.points[0]) + index[0]].value);
  }
  return sum;
}

namespace {

// The matrix of Stokes drag on the ball of equal volume; a body without volume has none.
void add_stokes_drag(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, Mat6& matrix) {
  double volume = 0.0;
  for (const ShapeId id : w.bodies.shapes[body])
    if (acts_on_shape(w, field, id.index)) volume += double(volume_of(w.shapes.colliders[id.index].shape));
  if (!(volume > 0.0)) return;
  const double radius = exp(log(volume * 3.0 / (4.0 * kPiDouble)) / 3.0);
  const double linear = 6.0 * kPiDouble * double(field.strength) * radius;
  for (int i = 0; i < 3; ++i) {
    matrix.m[i][i] += linear;
    matrix.m[3 + i][3 + i] += 4.0 / 3.0 * linear * radius * radius;
  }
}

}  // namespace

void add_drag(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, const BodyState& state,
              const Vec6& stream, Mat6& matrix) {
  if (field.kind == FieldKind::stokes) return add_stokes_drag(w, field, body, matrix);
  Vec6 against = stream;
  add(against, make_vec6(-state.velocity, -state.spin));
  const double half = 0.5 * double(field.density) * double(field.drag_coefficient);
  if (half > 0.0) {
    DragSum sum;
    for (const ShapeId id : w.bodies.shapes[body]) {
      if (!acts_on_shape(w, field, id.index)) continue;
      const ShapeState at = state_of(w, body, id.index, state);
      sum.add_scaled(half,
                     shape_drag(w.shapes.colliders[id.index].shape, at, plane_of(field, state, at), against));
    }
    add_drag_matrix(matrix, sum);
  }
  if (!(field.linear_drag > 0.0f)) return;
  const double share = field.kind == FieldKind::buoyancy ? submerged_share(w, field, body, state) : 1.0;
  if (share > 0.0) add_linear_drag(w, body, state, share * double(field.linear_drag), matrix);
}

RadialForce radial_force_at(const FieldRecord& field, DVec3 position) {
  const DVec3 from = position - field.center;
  const double square = length_squared(from) + double(field.core) * double(field.core);
  RadialForce out;
  if (!(square > 0.0)) return out;
  const double radius = double(field.radius), n = double(field.falloff);
  const double ratio = square / (radius * radius);
  // strength (radius / distance)^n / distance. Integer powers need no logarithms, so they are as exact as possible.
  const double distance = std::sqrt(square);
  const double power = n == 2.0    ? 1.0 / ratio
                       : n == 0.0  ? 1.0
                       : n == 1.0  ? 1.0 / std::sqrt(ratio)
                       : n == -1.0 ? std::sqrt(ratio)
                                   : exp(-0.5 * n * log(ratio));
  const double slope = double(field.strength) * power / distance;
  out.acceleration = -slope * from;
  out.stiffness = absolute(slope) * max(1.0, absolute(n));
  return out;
}

void add_buoyancy(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, const BodyState& state,
                  double gravity, Vec6& force, Mat6& stiffness) {
  const DVec3 up(field.normal);
  const double weight = double(field.density) * gravity;
  for (const ShapeId id : w.bodies.shapes[body]) {
    if (!acts_on_shape(w, field, id.index)) continue;
    const ShapeState at = state_of(w, body, id.index, state);
    const ShapePlane plane = plane_of(field, state, at);
    const SubmergedPart part = submerged_part(w.shapes.colliders[id.index].shape, plane.normal, plane.level);
    if (!(part.volume > 0.0)) continue;
    const DVec3 arm = at.offset + rotate(at.orientation, part.center);
    const double buoyancy = weight * part.volume;
    add(force, make_vec6(buoyancy * up, cross(arm, buoyancy * up)));
    // A body that hangs below its centre of buoyancy swings back like a pendulum.
    const double swing = max(buoyancy * dot(arm, up), 0.0);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) stiffness.m[3 + i][3 + j] += swing * ((i == j ? 1.0 : 0.0) - up[i] * up[j]);
    }
    if (!(part.area > 0.0)) continue;
    // The water plane at r resists with weight (up, r x up) (up, r x up)' dA: its centroid as a point, and its second
    // moments about that.
    const DVec3 middle = at.offset + rotate(at.orientation, part.area_center);
    add_row(stiffness, weight * part.area, make_vec6(up, cross(middle, up)));
    const SecondMoments& s = part.spread;
    const DVec3 axes[3] = {rotate(at.orientation, {1, 0, 0}), rotate(at.orientation, {0, 1, 0}),
                           rotate(at.orientation, {0, 0, 1})};
    const double spread[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const DVec3 a = cross(axes[i], up), b = cross(axes[j], up);
        for (int k = 0; k < 3; ++k) {
          for (int l = 0; l < 3; ++l) stiffness.m[3 + k][3 + l] += weight * spread[i][j] * a[k] * b[l];
        }
      }
    }
  }
}

}  // namespace gyre
