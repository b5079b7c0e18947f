// Explosions: impulses on the surfaces that face a point. Bodies are independent of each other and visited by slot.
//
// Occlusion is tested with rays from the centre to the middle of each shape of a body and to eight more points in it.
// The share of unobstructed rays scales the impulse.
#include "geometry/mass/surface_patches.h"
#include "math/rotation.h"
#include "math/trig.h"
#include "rigid/sleep/island.h"
#include "rigid/rigid_step.h"
#include "world/field_commands.h"
#include "world/query_sight.h"
#include "world/world_state.h"

namespace gyre {

namespace {

struct BodyImpulse {
  DVec3 linear, angular;  // N s, N m s about the centre of mass
};

// Pressure at a distance (m), Pa s.
double pressure_at(const ExplosionDef& def, double distance) {
  if (distance > double(def.radius)) return 0.0;
  const double ratio = double(def.reference) / max(distance, double(def.reference));
  const double n = double(def.falloff);
  const double share = n == 0.0 ? 1.0 : n == 1.0 ? ratio : n == 2.0 ? ratio * ratio : exp(n * log(ratio));
  return double(def.pressure) * share;
}

struct ShapeAt {
  const Shape* shape;
  DVec3 origin;  // world
  DQuat orientation;
};
ShapeAt shape_at(const RigidWorld& w, std::uint32_t shape) {
  const BodyPose& body_pose = w.bodies.poses[w.shapes.bodies[shape]];
  const Transform& local = w.shapes.body_from_shape[shape];
  const DQuat body = normalized(to_double(body_pose.orientation));
  const DVec3 from_center = DVec3(local.position) - DVec3(w.bodies.masses[w.shapes.bodies[shape]].center);
  return {&w.shapes.colliders[shape].shape, body_pose.center + rotate(body, from_center),
          body * to_double(local.orientation)};
}

// Sums over patches of round shapes deviate slightly from the projected area. This factor makes the sum exact for a
// far explosion.
double shadow_scale(const ShapeAt& at, DVec3 center) {
  const ShapeKind kind = at.shape->kind;
  const DVec3 from = rotate_inverse(at.orientation, at.origin - center);
  const double distance = length(from);
  if (kind == ShapeKind::box || kind == ShapeKind::hull || !(distance > 0.0)) return 1.0;
  const DVec3 direction = from / distance;
  double facing = 0.0;
  for_each_patch(*at.shape, {0, 1, 0}, double(kUnbounded), [&](const SurfacePatch& patch) {
    facing += max(-dot(direction, patch.normal), 0.0) * patch.area;
  });
  return facing > 0.0 ? projected_area(*at.shape, direction) / facing : 1.0;
}

BodyImpulse explosion_impulse_on(const RigidWorld& w, std::uint32_t body, const ExplosionDef& def) {
  BodyImpulse impulse;
  for (const ShapeId id : w.bodies.shapes[body]) {
    const Proxy& proxy = w.shapes.proxies[id.index];
    if (proxy.sensor || (proxy.filter.layer & def.layers) == 0) continue;
    const ShapeAt at = shape_at(w, id.index);
    const double scale = shadow_scale(at, def.center);
    for_each_patch(*at.shape, {0, 1, 0}, double(kUnbounded), [&](const SurfacePatch& patch) {
      const DVec3 position = at.origin + rotate(at.orientation, patch.position);
      const DVec3 from = position - def.center;
      const double distance = length(from);
      if (!(distance > 0.0)) return;
      const double facing = -dot(from, rotate(at.orientation, patch.normal)) / distance;
      if (facing <= 0.0) return;
      const DVec3 patch_impulse =
          (scale * pressure_at(def, distance) * facing * patch.area / distance) * from;
      impulse.linear += patch_impulse;
      impulse.angular += cross(position - w.bodies.poses[body].center, patch_impulse);
    });
  }
  return impulse;
}

// The share of the body that is visible from the centre.
double visible_share(WorldState& s, std::uint32_t body, DVec3 center) {
  const RigidWorld& w = s.rigid;
  int tested = 0, visible = 0;
  for (const ShapeId id : w.bodies.shapes[body]) {
    if (w.shapes.proxies[id.index].sensor) continue;
    const ShapeAt at = shape_at(w, id.index);
    const Aabb box = bounds(*at.shape, {});
    const DVec3 middle = 0.5 * (DVec3(box.low) + DVec3(box.high)),
                half = 0.5 * (DVec3(box.high) - DVec3(box.low));
    for (int corner = -1; corner < 8; ++corner) {
      DVec3 point = middle;
      // At half the size of the box of the shape: inside of most shapes.
      if (corner >= 0) {
        point += DVec3{(corner & 1) != 0 ? 0.5 * half.x : -0.5 * half.x,
                       (corner & 2) != 0 ? 0.5 * half.y : -0.5 * half.y,
                       (corner & 4) != 0 ? 0.5 * half.z : -0.5 * half.z};
      }
      ++tested;
      visible += is_in_sight(s, center, at.origin + rotate(at.orientation, point), body) ? 1 : 0;
    }
  }
  return tested > 0 ? double(visible) / tested : 0.0;
}

}  // namespace

CommandResult execute(WorldState& s, const Explode& c) {
  RigidWorld& w = s.rigid;
  const ExplosionDef& def = c.def;
  w.bodies.ids.for_each_live([&](std::uint32_t body) {
    if (!is_movable(w.bodies.flags[body])) return;
    const double distance = length(w.bodies.poses[body].center - def.center);
    if (distance > double(def.radius) + double(w.bodies.masses[body].bounding_radius)) return;
    BodyImpulse impulse = explosion_impulse_on(w, body, def);
    if (impulse.linear == DVec3{} && impulse.angular == DVec3{}) return;
    const double share = def.occlusion ? visible_share(s, body, def.center) : 1.0;
    if (share == 0.0) return;
    const BodyInertia& inertia = w.bodies.inertia[body];
    BodyMotion& motion = w.bodies.motion[body];
    const Vec3 linear = motion.linear_velocity + inertia.inverse_mass * to_float(share * impulse.linear);
    const Vec3 angular = motion.angular_velocity + inertia.inverse * to_float(share * impulse.angular);
    if (!is_finite(linear) || !is_finite(angular)) return;
    wake(w, body);
    motion.linear_velocity = linear + Vec3{};
    motion.angular_velocity = angular + Vec3{};
    mark_moved(w, body);
  });
  return {true, {}, {}, {}};
}

}  // namespace gyre
