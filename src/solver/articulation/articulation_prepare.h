// Prepares the joints of a bundle in a sub-step, and the matrix of their equations
// (solver/articulation/articulation_lanes.h), as prepare_joint() and prepare_articulation() for a single
// articulation, without the zeros of a ball joint's rows.
#pragma once

#include "math/wide_angle.h"
#include "solver/articulation/articulation_block.h"

#include <type_traits>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
GYRE_INLINE Vec3W<W> clamp_length(Vec3W<W> v, std::type_identity_t<Wide<W>> max_length) {
  const Wide<W> size = length(v);
  const Mask<W> beyond = size > max_length;
  if (!any(beyond)) return v;
  return select(beyond, (max_length / size) * v, v);
}

// -------------------------------------------------------------------------------------------------------------- limits

template <int W>
GYRE_INLINE void prepare_limit_axis(WideLimitAxis<W>& axis, Vec3W<W> about, const WideBody<W>& a,
                                    const WideBody<W>& b) {
  axis.about = about;
  const Wide<W> k = dot(about, a.own_inverse * about) + dot(about, b.own_inverse * about);
  axis.mass = keep(k > 0.0f, 1.0f / k);
}

// `slack`: distance by which both limits are moved outwards.
template <int W>
GYRE_INLINE void prepare_twist(WideLimitAxis<W>& axis, Wide<W> position, Wide<W> slack = Wide<W>(0.0f)) {
  axis.low_gap = max(position - axis.low + slack, Wide<W>(-kMaxErrors.rotation));
  axis.high_gap = max(axis.high - position + slack, Wide<W>(-kMaxErrors.rotation));
}

// The angle near which the twist of a joint is unwrapped: for a cone the middle of its limits if these are
// less than a turn apart, else the last twist.
template <int W>
GYRE_INLINE Wide<W> twist_reference(const LaneNode& node, const WideJoint<W>& joint) {
  if (node.kind == JointKind::hinge || !node.has_twist) return joint.position;
  const WideLimitAxis<W>& axis = joint.twist;
  return select(axis.high - axis.low < 2.0f * kWidePi, 0.5f * (axis.low + axis.high), joint.position);
}

// The swing of a cone: its distance to the limit, and the axis about which the limit is nearest, as
// find_swing_limit() of solver/joint/joint_kinds.cpp.
template <int W>
GYRE_INLINE void prepare_swing(WideJoint<W>& joint, const Mat3W<W>& frame_a, Vec3W<W> x_b,
                               const WideBody<W>& a, const WideBody<W>& b) {
  const Vec3W<W> across_both = cross(frame_a.x, x_b);
  const Wide<W> sine = length(across_both);
  const Wide<W> angle = atan2(sine, dot(frame_a.x, x_b));
  const Mask<W> leans = sine > 1.0e-6f;
  const Vec3W<W> along = across_both / select(leans, sine, Wide<W>(1.0f));
  const Wide<W> cy = dot(along, frame_a.y), cz = dot(along, frame_a.z);
  const Wide<W> y = cy * joint.inverse_swing_y, z = cz * joint.inverse_swing_z;
  const Wide<W> share = sqrt(y * y + z * z);
  const Wide<W> across = cy * cz * (square(joint.inverse_swing_z) - square(joint.inverse_swing_y)) / share;
  const Vec3W<W> raw = share * along + (across * angle / sine) * cross(x_b, along);
  const Wide<W> size = length(raw);
  // Opposite to a's axis all directions are equal; along it the limit is far.
  const Mask<W> opposite = and_not(angle > 1.0f, leans);
  const Wide<W> smallest = 1.0f / max(joint.inverse_swing_y, joint.inverse_swing_z);
  Vec3W<W> about = keep(opposite, frame_a.y);
  about = select(leans, raw / size, about);
  Wide<W> gap = select(opposite, smallest - angle, Wide<W>(kUnreachable));
  gap = select(leans, (1.0f - share * angle) / size, gap);
  prepare_limit_axis(joint.swing, about, a, b);
  joint.swing.low_gap = gap;  // without bound
  joint.swing.high_gap = max(gap, Wide<W>(-kMaxErrors.rotation));
}

// ------------------------------------------------------------------------------------------------------------- joints

template <int W>
GYRE_INLINE void prepare_lane_joint(const LaneNode& node, WideJoint<W>& joint, const WideBody<W>& a,
                                    const WideBody<W>& b) {
  joint.from_a = rotate(a.orientation, joint.local_a);
  joint.from_b = rotate(b.orientation, joint.local_b);
  joint.error = joint.offset + (b.delta_position - a.delta_position) + joint.from_b - joint.from_a;
  if (node.kind == JointKind::ball) return;
  const QuatW<W> world_frame_a = a.orientation * joint.local_frame_a,
                 world_frame_b = b.orientation * joint.local_frame_b;
  const Mat3W<W> frame_a = to_matrix(world_frame_a);
  const Vec3W<W> x_b = rotate(world_frame_b, Vec3W<W>{1.0f, 0.0f, 0.0f});
  const QuatW<W> twist = conjugate(world_frame_a) * world_frame_b;
  joint.position = unwrapped(2.0f * atan2(twist.x, twist.w), twist_reference(node, joint));
  if (node.kind == JointKind::hinge) {
    joint.axis = frame_a.x;
    joint.perpendicular_1 = frame_a.y;
    joint.perpendicular_2 = frame_a.z;
    joint.angular_error = clamp_length(cross(frame_a.x, x_b), kMaxErrors.rotation);
    if (!node.has_twist) return;
    prepare_twist(joint.twist, joint.position);
    prepare_limit_axis(joint.twist, frame_a.x, a, b);
    return;
  }
  // Half-way between the axes of a and b.
  if (node.has_twist) {
    const Wide<W> certainty = 1.0f + dot(frame_a.x, x_b);
    prepare_twist(joint.twist, joint.position, keep(certainty < kMinTwistReported, Wide<W>(kUnreachable)));
    prepare_limit_axis(joint.twist, (frame_a.x + x_b) / max(certainty, Wide<W>(0.05f)), a, b);
  }
  if (node.has_swing) prepare_swing(joint, frame_a, x_b, a, b);
}

// ----------------------------------------------------------------------------------------------------------- geometric stiffness

template <int W>
GYRE_INLINE void add_geometric_stiffness_term(WideBody<W>& body, Vec3W<W> r, Vec3W<W> f) {
  const Wide<W> k = dot(r, f);
  body.geometric_stiffness = body.geometric_stiffness + Sym3W<W>{k - r.x * f.x,
                                                                 k - r.y * f.y,
                                                                 k - r.z * f.z,
                                                                 -0.5f * (r.x * f.y + r.y * f.x),
                                                                 -0.5f * (r.x * f.z + r.z * f.x),
                                                                 -0.5f * (r.y * f.z + r.z * f.y)};
}

// As stiffen_bodies() of solver/articulation/articulation.cpp. Few bodies have so much tension.
template <int W>
GYRE_INLINE void stiffen_body(WideBody<W>& body, const LaneSettings& s) {
  const Sym3W<W>& i = body.inverse;
  const Sym3W<W>& p = body.geometric_stiffness;
  const Wide<W> trace =
      i.xx * p.xx + i.yy * p.yy + i.zz * p.zz + 2.0f * (i.xy * p.xy + i.xz * p.xz + i.yz * p.yz);
  const Wide<W> unresolved = (0.5f * s.substep * s.substep) * trace;
  const Mask<W> stiffened = (unresolved > kGeometricStiffnessThreshold) &
                            (WideInt<W>::load_unaligned(body.pressed) == WideInt<W>(0));
  if (!any(stiffened)) return;
  const Wide<W> stiffnesses[6] = {p.xx, p.yy, p.zz, p.xy, p.xz, p.yz};
  const Wide<W> inertias[6] = {body.inertia.xx, body.inertia.yy, body.inertia.zz,
                               body.inertia.xy, body.inertia.xz, body.inertia.yz};
  Wide<W> out[6] = {i.xx, i.yy, i.zz, i.xy, i.xz, i.yz};
  for (int lane = 0; lane < W; ++lane) {
    if (!stiffened[lane]) continue;
    float geometric_stiffness[6], inertia[6], inverse[6];
    for (int k = 0; k < 6; ++k) geometric_stiffness[k] = stiffnesses[k][lane], inertia[k] = inertias[k][lane];
    const float share = s.substep * s.substep * (1.0f - kGeometricStiffnessThreshold / unresolved[lane]);
    s.add_geometric_stiffness(geometric_stiffness, inertia, share, inverse);
    for (int k = 0; k < 6; ++k) out[k].set(lane, inverse[k]);
  }
  body.inverse = {out[0], out[1], out[2], out[3], out[4], out[5]};
}

// ------------------------------------------------------------------------------------------------------------- matrix

// Spins of a body for an impulse along each world axis at `r`: inverse inertia times r x axis.
template <int W>
GYRE_INLINE Mat3W<W> spins_at(const Sym3W<W>& i, Vec3W<W> r) {
  return {{i.xy * r.z - i.xz * r.y, i.yy * r.z - i.yz * r.y, i.yz * r.z - i.zz * r.y},
          {i.xz * r.x - i.xx * r.z, i.yz * r.x - i.xy * r.z, i.zz * r.x - i.xz * r.z},
          {i.xx * r.y - i.xy * r.x, i.xy * r.y - i.yy * r.x, i.xz * r.y - i.yz * r.x}};
}

// K + compliance of a joint's own rows.
template <int W>
GYRE_INLINE void make_diagonal_block(const WideBundle<W>& bundle, const LaneNode& node, float compliance) {
  WideJoint<W>& joint = bundle.joints[&node - bundle.plain.nodes];
  const WideBody<W>&a = bundle.bodies[node.a], &b = bundle.bodies[node.b];
  const Wide<W> mass = a.inverse_mass + b.inverse_mass;
  const Mat3W<W> spins_a = spins_at(a.inverse, joint.from_a), spins_b = spins_at(b.inverse, joint.from_b);
  // Row i of r x (spin i) by column: (spin x r) . axis.
  const Vec3W<W> x = cross(spins_a.x, joint.from_a) + cross(spins_b.x, joint.from_b);
  const Vec3W<W> y = cross(spins_a.y, joint.from_a) + cross(spins_b.y, joint.from_b);
  const Vec3W<W> z = cross(spins_a.z, joint.from_a) + cross(spins_b.z, joint.from_b);
  const std::uint32_t at = node.diagonal, n = node.rows;
  const Vec3W<W> own{mass + x.x, mass + y.y, mass + z.z};
  joint.compliance = compliance * own;
  bundle.set_value(at, own.x + joint.compliance.x);
  bundle.set_value(at + n, y.x);
  bundle.set_value(at + n + 1, own.y + joint.compliance.y);
  bundle.set_value(at + 2 * n, z.x);
  bundle.set_value(at + 2 * n + 1, z.y);
  bundle.set_value(at + 2 * n + 2, own.z + joint.compliance.z);
  if (n == 3) return;
  const Vec3W<W> p = joint.perpendicular_1, q = joint.perpendicular_2;
  bundle.set_value(at + 3 * n, dot(p, spins_a.x) + dot(p, spins_b.x));
  bundle.set_value(at + 3 * n + 1, dot(p, spins_a.y) + dot(p, spins_b.y));
  bundle.set_value(at + 3 * n + 2, dot(p, spins_a.z) + dot(p, spins_b.z));
  bundle.set_value(at + 4 * n, dot(q, spins_a.x) + dot(q, spins_b.x));
  bundle.set_value(at + 4 * n + 1, dot(q, spins_a.y) + dot(q, spins_b.y));
  bundle.set_value(at + 4 * n + 2, dot(q, spins_a.z) + dot(q, spins_b.z));
  const Vec3W<W> spin_p = a.inverse * p + b.inverse * p, spin_q = a.inverse * q + b.inverse * q;
  const Wide<W> kp = dot(p, spin_p), kq = dot(q, spin_q);
  joint.angular_compliance_1 = compliance * kp;
  joint.angular_compliance_2 = compliance * kq;
  bundle.set_value(at + 3 * n + 3, kp + joint.angular_compliance_1);
  bundle.set_value(at + 4 * n + 3, dot(p, spin_q));
  bundle.set_value(at + 4 * n + 4, kq + joint.angular_compliance_2);
}

// One row of the coupling by a shared body, from the spin of an impulse of one.
template <int W>
GYRE_INLINE void put_coupled_row(const WideBundle<W>& bundle, std::uint32_t at, Vec3W<W> direction,
                                 Vec3W<W> spin, Vec3W<W> r, const WideJoint<W>& column, bool is_hinge,
                                 bool is_first) {
  const auto put = [&](std::uint32_t i, Wide<W> v) {
    is_first ? bundle.set_value(i, v) : bundle.add_value(i, v);
  };
  const Vec3W<W> k = direction + cross(spin, r);
  put(at, k.x);
  put(at + 1, k.y);
  put(at + 2, k.z);
  if (!is_hinge) return;
  put(at + 3, dot(spin, column.perpendicular_1));
  put(at + 4, dot(spin, column.perpendicular_2));
}

// Signs differ because a gets the opposite of b.
template <int W>
GYRE_INLINE void put_coupling(const WideBundle<W>& bundle, const LaneCoupling& coupling) {
  const WideJoint<W>&row = bundle.joints[coupling.row], &column = bundle.joints[coupling.column];
  const WideBody<W>& body = bundle.bodies[coupling.body];
  const float sign = coupling.row_has_b == coupling.column_has_b ? 1.0f : -1.0f;
  const Sym3W<W> inverse = Wide<W>(sign) * body.inverse;
  const Wide<W> mass = sign * body.inverse_mass, none(0.0f);
  const Mat3W<W> spins = spins_at(inverse, coupling.row_has_b ? row.from_b : row.from_a);
  const Vec3W<W> r = coupling.column_has_b ? column.from_b : column.from_a;
  const std::uint32_t n = bundle.plain.nodes[coupling.column].rows, at = coupling.offset;
  const bool first = coupling.is_first;
  put_coupled_row(bundle, at, {mass, none, none}, spins.x, r, column, n == 5, first);
  put_coupled_row(bundle, at + n, {none, mass, none}, spins.y, r, column, n == 5, first);
  put_coupled_row(bundle, at + 2 * n, {none, none, mass}, spins.z, r, column, n == 5, first);
  if (bundle.plain.nodes[coupling.row].rows == 3) return;
  const Vec3W<W> nothing{none, none, none};
  put_coupled_row(bundle, at + 3 * n, nothing, inverse * row.perpendicular_1, r, column, n == 5, first);
  put_coupled_row(bundle, at + 4 * n, nothing, inverse * row.perpendicular_2, r, column, n == 5, first);
}

template <int W>
void clear_values(const ArticulationBundle& plain) {
  for (std::uint32_t i = 0; i < plain.value_count; ++i) Wide<W>(0.0f).store(plain.values + i * W);
}

// Prepares the rows at the present poses, and their diagonal blocks of the matrix.
template <int W>
void prepare_bundle(const ArticulationBundle& plain, const LaneArrays& arrays, const LaneSettings& s) {
  const WideBundle<W> bundle(plain);
  load_poses(bundle, arrays);
  const float per_substep = 1.0f / s.substep;
  for (std::uint32_t n = 0; n < plain.node_count; ++n) {
    const LaneNode& node = plain.nodes[n];
    WideJoint<W>& joint = bundle.joints[n];
    WideBody<W>&a = bundle.bodies[node.a], &b = bundle.bodies[node.b];
    prepare_lane_joint(node, joint, a, b);
    const Vec3W<W> force = per_substep * joint.linear_impulse;
    if (bundle.moves(node.a)) add_geometric_stiffness_term(a, joint.from_a, -force);
    if (bundle.moves(node.b)) add_geometric_stiffness_term(b, joint.from_b, force);
  }
  for (std::uint32_t i = 0; i < plain.moving_count; ++i) stiffen_body(bundle.bodies[i], s);
  if (plain.has_fill) clear_values<W>(plain);
  for (std::uint32_t n = 0; n < plain.node_count; ++n)
    make_diagonal_block(bundle, plain.nodes[n], s.compliance);
  *plain.is_factored = false;
}

// The couplings and the factors of the matrix. Not inlined: it is long and has many callers.
template <int W>
__attribute__((noinline)) void make_factors(const WideBundle<W>& bundle) {
  const ArticulationBundle& plain = bundle.plain;
  for (std::uint32_t i = 0; i < plain.coupling_count; ++i) put_coupling(bundle, plain.couplings[i]);
  factor_lanes<W>(plain);
  *plain.is_factored = true;
}
// Factors before the first solve. Freely falling articulations need none.
template <int W>
GYRE_INLINE void factor_bundle(const WideBundle<W>& bundle) {
  if (!*bundle.plain.is_factored) make_factors<W>(bundle);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
