// The fields of every state record, one function for each record. Exactly these fields are saved, loaded, hashed and
// compared, without padding and in this order. f is called with one scalar, vector or enum at a time; FieldWriter and
// similar classes (io/snapshot/snapshot) take vectors apart.
#pragma once

#include "collision/contact/contact_store.h"
#include "collision/broadphase/proxy.h"
#include "rigid/store/rigid_world.h"
#include "fluid/store/fluid_store.h"
#include "soft/store/soft_store.h"

namespace gyre {

// Scalars are their own single field.
template <class T, class F>
  requires(std::is_arithmetic_v<std::remove_const_t<T>> || std::is_enum_v<std::remove_const_t<T>>)
void for_each_field(T& value, F&& f) {
  f(value);
}

template <class T, class Of>
concept Is = std::is_same_v<std::remove_const_t<T>, Of>;

template <Is<Vec3> T, class F>
void for_each_field(T& v, F&& f) {
  f(v.x), f(v.y), f(v.z);
}
template <Is<DVec3> T, class F>
void for_each_field(T& v, F&& f) {
  f(v.x), f(v.y), f(v.z);
}
template <Is<Quat> T, class F>
void for_each_field(T& q, F&& f) {
  f(q.x), f(q.y), f(q.z), f(q.w);
}
template <Is<Sym3> T, class F>
void for_each_field(T& m, F&& f) {
  f(m.xx), f(m.yy), f(m.zz), f(m.xy), f(m.xz), f(m.yz);
}
template <Is<Transform> T, class F>
void for_each_field(T& t, F&& f) {
  for_each_field(t.position, f), for_each_field(t.orientation, f);
}
template <Is<Aabb> T, class F>
void for_each_field(T& box, F&& f) {
  for_each_field(box.low, f), for_each_field(box.high, f);
}
template <Is<Filter> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.layer), f(r.collides_with), f(r.group);
}
template <Is<Material> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.static_friction), f(r.dynamic_friction), f(r.restitution), f(r.rolling_friction), f(r.spinning_friction), f(r.id);
}
template <Is<MaterialPair> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.a), f(r.b), f(r.static_friction), f(r.dynamic_friction), f(r.restitution);
}
template <Is<SurfaceRule> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.id), for_each_field(r.material, f), for_each_field(r.velocity, f), for_each_field(r.one_way, f);
}
template <Is<FieldRecord> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.generation), f(r.kind), f(r.has_bounds), f(r.layers), for_each_field(r.low, f), for_each_field(r.high, f);
  for_each_field(r.velocity, f), f(r.density), f(r.drag_coefficient), f(r.linear_drag), f(r.turbulence), f(r.turbulence_length);
  for_each_field(r.center, f), f(r.strength), f(r.radius), f(r.falloff), f(r.core);
  for_each_field(r.axis, f), for_each_field(r.normal, f), f(r.offset);
}
template <Is<BodyMotion> T, class F>
void for_each_field(T& r, F&& f) {
  // The motion of the step is valid within a step only; the inverse mass follows from the mass.
  for_each_field(r.linear_velocity, f), for_each_field(r.angular_velocity, f);
}
template <Is<BodyPose> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.center, f), for_each_field(r.orientation, f);
}
template <Is<BodyMass> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.mass), f(r.inverse_mass), for_each_field(r.center, f), for_each_field(r.inertia, f);
  for_each_field(r.inverse_inertia, f), f(r.bounding_radius), f(r.size), f(r.isotropic);
}
template <Is<BodyForces> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.force, f), for_each_field(r.torque, f);
  f(r.linear_damping), f(r.angular_damping), f(r.gravity_scale);
}
template <Is<BodyFlags> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.type), f(r.awake), f(r.can_sleep), f(r.continuous), f(r.frozen), f(r.locked_linear),
      f(r.locked_angular), f(r.constraint_use);
}
template <Is<BodySleep> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.still_time), f(r.group), f(r.next_in_group);
}
template <Is<BodyOverrides> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.has_mass), f(r.has_center), f(r.has_inertia), f(r.mass), for_each_field(r.center, f), for_each_field(r.inertia, f);
}
template <Is<Proxy> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.fat_box, f), for_each_field(r.filter, f), f(r.body), f(r.motion), f(r.sensor), f(r.pushes);
}
template <Is<ContactSurface> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.static_friction), f(r.dynamic_friction), f(r.restitution), f(r.rolling_friction), f(r.spinning_friction);
}
template <Is<PairCache> T, class F>
void for_each_field(T& r, F&& f) {
  for (auto& word : r.words) f(word);
}
template <Is<Contact> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.shape_a), f(r.shape_b), f(r.body_a), f(r.body_b), f(r.first_manifold), f(r.manifold_room), f(r.manifold_count);
  f(r.sensor), f(r.touching), f(r.recycled), f(r.ended), f(r.cached_distance), f(r.size);
  for_each_field(r.surface, f), for_each_field(r.cache, f), for_each_field(r.seen_a_from_b, f);
}
template <Is<ContactPointState> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.from_a, f), f(r.separation), for_each_field(r.from_b, f), f(r.normal_impulse), f(r.total_impulse);
  f(r.approach_speed), f(r.feature), f(r.mean_impulse);
}
template <Is<Manifold> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.normal, f), f(r.count), f(r.load_age);
  for (auto& point : r.points) for_each_field(point, f);
  for_each_field(r.friction_impulse, f), f(r.twist_impulse), for_each_field(r.rolling_impulse, f), f(r.triangle);
  for_each_field(r.total_friction, f), f(r.sliding), for_each_field(r.anchor_normal, f);
  for (auto& anchor : r.anchors) for_each_field(anchor.position, f), f(anchor.separation);
}
template <Is<JointRecord> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.kind), f(r.has_limits), f(r.is_spring), f(r.collide_connected), f(r.has_motor_target), f(r.body_a), f(r.body_b);
  for_each_field(r.local_anchor_a, f), for_each_field(r.local_anchor_b, f);
  for_each_field(r.local_frame_a, f), for_each_field(r.local_frame_b, f);
  for_each_field(r.world_anchor_a, f), for_each_field(r.world_anchor_b, f);
  f(r.limits.low), f(r.limits.high);
  f(r.motor_velocity), f(r.motor_position), f(r.motor_force), f(r.motor_frequency), f(r.motor_damping);
  f(r.rest_length), f(r.min_length), f(r.max_length), f(r.stiffness), f(r.damping), f(r.break_force), f(r.break_torque);
  for_each_field(r.linear_impulse, f), for_each_field(r.angular_impulse, f);
  f(r.low_impulse), f(r.high_impulse), f(r.motor_impulse), f(r.spring_impulse), f(r.position);
  for_each_field(r.total_linear, f), for_each_field(r.total_angular, f);
}
template <Is<JointAxisRecord> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.motion), f(r.has_motor_target), f(r.limits.low), f(r.limits.high), f(r.limit_frequency), f(r.limit_damping);
  f(r.motor_velocity), f(r.motor_position), f(r.motor_force), f(r.motor_frequency), f(r.motor_damping);
  f(r.stiffness), f(r.damping), f(r.rest_position), f(r.friction), f(r.locked_position);
  f(r.low_impulse), f(r.high_impulse), f(r.motor_impulse), f(r.spring_impulse), f(r.friction_impulse);
  f(r.position), f(r.total);
}
template <Is<PoseDrive> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.position, f), for_each_field(r.orientation, f);
  for_each_field(r.linear_velocity, f), for_each_field(r.angular_velocity, f);
  f(r.frequency), f(r.damping_ratio), f(r.max_force), f(r.max_torque);
}
template <Is<JointDetail> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.used), f(r.disabled), f(r.path_closed), f(r.has_swing), f(r.path_orientation);
  for (auto& axis : r.axes) for_each_field(axis, f);
  for (auto& impulse : r.row_impulses) f(impulse);
  for_each_field(r.drive, f), for_each_field(r.drive_force_impulse, f), for_each_field(r.drive_torque_impulse, f);
  f(r.friction), for_each_field(r.friction_impulse, f), f(r.swing_y), f(r.swing_z), f(r.ratio);
  for_each_field(r.reference_a, f), for_each_field(r.reference_b, f), f(r.start);
  for_each_field(r.ground_a, f), for_each_field(r.ground_b, f);
  f(r.path_first), f(r.path_count), f(r.path_parameter);
}
template <Is<PathPoint> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.position, f), f(r.along), for_each_field(r.up, f);
}
template <Is<MotionSettings> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.integrator), f(r.springs), f(r.time), f(r.tolerance), f(r.max_impacts), f(r.planned_substeps);
}
template <Is<LastMove> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.moved, f), for_each_field(r.turned, f), f(r.seconds);
  for_each_field(r.linear, f), for_each_field(r.angular, f);
}
template <Is<SolverSettings> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.kind), f(r.options.lcp_method), f(r.options.friction_sides), f(r.options.iterations), f(r.options.direct_rows);
}
template <Is<SleepSettings> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.share);
}
template <Is<IgnoredPair> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.a), f(r.b);
}
template <Is<FieldGrid> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.first), f(r.count);
  for (auto& points : r.points) f(points);
}
template <Is<FieldVector> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.value, f);
}
template <Is<CouplingRecord> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.generation), f(r.count);
  for (auto& joint : r.joints) f(joint);
  for (auto& axis : r.axes) f(axis);
  for (auto& coefficient : r.coefficients) f(coefficient);
  f(r.offset), f(r.impulse), f(r.total);
}
template <Is<BodySleepSpeed> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.speed);
}
template <Is<SoftRest> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.still_time), f(r.asleep);
}
template <Is<SoftAttachment> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.particle), f(r.body), for_each_field(r.place, f), for_each_field(r.local, f), for_each_field(r.impulse, f);
}
template <Is<SoftPointAttachment> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.element), f(r.body);
  for (auto& one : r.weight) f(one);
  for_each_field(r.place, f), for_each_field(r.local, f), for_each_field(r.impulse, f);
}
template <Is<SoftInside> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.particle), f(r.body);
}
template <Is<SoftLimit> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.target, f), f(r.distance), for_each_field(r.normal, f), f(r.backstop);
}
template <Is<SoftContact> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.particle), f(r.shape), f(r.body), f(r.triangle), for_each_field(r.normal, f), for_each_field(r.from_body, f), f(r.gap);
  f(r.static_friction), f(r.dynamic_friction), for_each_field(r.surface_velocity, f), for_each_field(r.impulse, f), f(r.grip);
}
template <Is<SoftFaceContact> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.at, f), f(r.others[0]), f(r.others[1]), f(r.weight[0]), f(r.weight[1]), f(r.weight[2]), f(r.face);
}
template <Is<GasEmitter> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.position, f), f(r.radius), f(r.density), f(r.temperature), for_each_field(r.velocity, f);
  f(r.has_velocity), f(r.start), f(r.end);
}
template <Is<FluidPush> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.body), for_each_field(r.force, f), for_each_field(r.torque, f);
}
template <Is<FluidVisitor> T, class F>
void for_each_field(T& r, F&& f) {
  f(r.index), f(r.generation), f(r.is_soft);
}
template <Is<CellBox> T, class F>
void for_each_field(T& r, F&& f) {
  for (auto& one : r.low) f(one);
  for (auto& one : r.high) f(one);
}
template <Is<FluidFrame> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.pose.position, f), for_each_field(r.pose.orientation, f);
  for_each_field(r.velocity, f), for_each_field(r.angular_velocity, f);
}
template <Is<RigidSettings> T, class F>
void for_each_field(T& r, F&& f) {
  for_each_field(r.gravity, f), f(r.substeps), f(r.sleeping), f(r.friction_rule), f(r.restitution_rule), f(r.last_substep);
  f(r.last_step);
}

}  // namespace gyre
