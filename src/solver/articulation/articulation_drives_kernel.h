// Drives, motors and dry friction of a bundle of articulations (solver/articulation/articulation_lanes.h), as
// solver/joint/pose_drive.h for a single joint, and for hinges as solver/joint/joint_axis.h. They are
// iterated joint by joint before the equations.
#pragma once

#include "solver/articulation/articulation_prepare.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// -------------------------------------------------------------------------------------------------------------- preparation

template <int W>
GYRE_INLINE void prepare_hinge_drives(const WideJoint<W>& joint, WideDrives<W>& d, const WideBody<W>& a,
                                      const WideBody<W>& b) {
  const Wide<W> k = dot(joint.axis, a.own_inverse * joint.axis) + dot(joint.axis, b.own_inverse * joint.axis);
  d.mass.xx = keep(k > 0.0f, 1.0f / k);
  d.error.x = joint.position - d.target.x;
  d.speed.x = d.target_speed.x;
}

template <int W>
__attribute__((noinline)) void prepare_lane_drives(const WideBundle<W>& bundle) {
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    if (!node.is_driven()) continue;
    const WideJoint<W>& joint = bundle.joints[n];
    const WideBody<W>&a = bundle.bodies[node.a], &b = bundle.bodies[node.b];
    WideDrives<W>& d = bundle.drives[node.drives];
    if (node.kind == JointKind::hinge) {
      prepare_hinge_drives(joint, d, a, b);
      continue;
    }
    d.mass = inverse(a.own_inverse + b.own_inverse);
    if (!node.has_drive) continue;
    const QuatW<W> frame_a = a.orientation * joint.local_frame_a,
                   frame_b = b.orientation * joint.local_frame_b;
    d.error = to_rotation_vector(frame_b * conjugate(frame_a * d.target));
    d.speed = rotate(frame_a, d.target_speed);
  }
}

// The limit solver reads them too.
template <int W>
__attribute__((noinline)) void prepare_lane_servos(const WideBundle<W>& bundle) {
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    if (!node.has_servo) continue;
    WideLimitAxis<W>& axis = bundle.servos[node.servo].axis;
    prepare_limit_axis(axis, bundle.joints[n].axis, bundle.bodies[node.a], bundle.bodies[node.b]);
    axis.low_gap = bundle.joints[n].position - axis.low;
  }
}

// -------------------------------------------------------------------------------------------------------------- iteration

// Applies an angular impulse to b, and its opposite to a, with inertias without geometric stiffness. (Not
// inlined: it has many callers.)
template <int W>
__attribute__((noinline)) void apply_drive_impulse(const WideBundle<W>& bundle, const LaneNode& node,
                                                   Vec3W<W> t) {
  if (bundle.moves(node.a)) bundle.bodies[node.a].angular -= bundle.bodies[node.a].own_inverse * t;
  if (bundle.moves(node.b)) bundle.bodies[node.b].angular += bundle.bodies[node.b].own_inverse * t;
}

template <int W>
GYRE_INLINE Vec3W<W> relative_spin_of(const WideBundle<W>& bundle, const LaneNode& node) {
  return bundle.bodies[node.b].angular - bundle.bodies[node.a].angular;
}

template <int W>
GYRE_INLINE void iterate_hinge_drives(const WideBundle<W>& bundle, const LaneNode& node, Vec3W<W> axis,
                                      WideDrives<W>& d, Mask<W> kept) {
  const auto change = [&](Wide<W>& accumulated, Wide<W> target, Wide<W> bound) {
    const Wide<W> now = min(max(target, Wide<W>(0.0f) - bound), bound);
    apply_drive_impulse(bundle, node, (now - accumulated) * axis);
    accumulated = now;
  };
  if (node.has_drive) {
    Wide<W>& accumulated = d.drive_impulse.x;
    const Wide<W> closing = dot(axis, relative_spin_of(bundle, node)) - d.speed.x + d.rate * d.error.x;
    const Wide<W> target = accumulated - d.mass_scale * d.mass.xx * closing - d.impulse_scale * accumulated;
    change(accumulated, select(kept, accumulated, target), d.max_drive);
  }
  if (node.has_friction) {
    Wide<W>& accumulated = d.friction_impulse.x;
    change(accumulated, accumulated - d.mass.xx * dot(axis, relative_spin_of(bundle, node)), d.max_friction);
  }
}

// `kept`: lanes whose drives keep their impulses.
template <int W>
__attribute__((noinline)) void iterate_drives(const WideBundle<W>& bundle,
                                              Mask<W> kept = Mask<W>::splat(false)) {
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    if (!node.is_driven()) continue;
    WideDrives<W>& d = bundle.drives[node.drives];
    if (node.kind == JointKind::hinge) {
      iterate_hinge_drives(bundle, node, bundle.joints[n].axis, d, kept);
      continue;
    }
    const auto change = [&](Vec3W<W>& accumulated, Vec3W<W> target, Wide<W> bound) {
      const Vec3W<W> now = clamp_length(target, bound);
      apply_drive_impulse(bundle, node, now - accumulated);
      accumulated = now;
    };
    if (node.has_drive) {
      Vec3W<W>& accumulated = d.drive_impulse;
      const Vec3W<W> closing = relative_spin_of(bundle, node) - d.speed + d.rate * d.error;
      const Vec3W<W> target = accumulated - d.mass_scale * (d.mass * closing) - d.impulse_scale * accumulated;
      change(accumulated, select<W>(kept, accumulated, target), d.max_drive);
    }
    if (node.has_friction)
      change(d.friction_impulse, d.friction_impulse - d.mass * relative_spin_of(bundle, node),
             d.max_friction);
  }
}

// ------------------------------------------------------------------------------------------------- impulses

// Of a joint's drive and friction together.
template <int W>
GYRE_INLINE Vec3W<W> total_impulse_of(const LaneNode& node, const WideDrives<W>& d) {
  if (!node.has_friction) return d.drive_impulse;
  return node.has_drive ? d.drive_impulse + d.friction_impulse : d.friction_impulse;
}
// As an angular impulse on b.
template <int W>
GYRE_INLINE Vec3W<W> driven_impulse(const LaneNode& node, const WideJoint<W>& joint, const WideDrives<W>& d) {
  const Vec3W<W> sum = total_impulse_of(node, d);
  return node.kind == JointKind::hinge ? sum.x * joint.axis : sum;
}

// Applies the last impulses of drives and equations again: an iteration must see all impulses of a joint, or
// it would hold against the fall of what the equations are about to hold.
template <int W>
GYRE_INLINE void warm_start_driven(const WideBundle<W>& bundle) {
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    WideJoint<W>& joint = bundle.joints[n];
    if (node.is_driven())
      apply_drive_impulse(bundle, node, driven_impulse(node, joint, bundle.drives[node.drives]));
    const Wide<W> zero(0.0f);
    Vec3W<W> angular{zero, zero, zero};
    if (node.kind == JointKind::hinge) {  // along its present rows
      angular = dot(joint.angular_impulse, joint.perpendicular_1) * joint.perpendicular_1 +
                dot(joint.angular_impulse, joint.perpendicular_2) * joint.perpendicular_2;
      joint.angular_impulse = angular;
    }
    apply_joint_impulse(bundle, node, joint, joint.linear_impulse, angular);
  }
}

template <int W>
GYRE_INLINE void accumulate_drives(const LaneNode& node, WideJoint<W>& joint, WideDrives<W>& d) {
  joint.total_angular += driven_impulse(node, joint, d);
  if (node.kind == JointKind::hinge) d.total += total_impulse_of(node, d).x;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
