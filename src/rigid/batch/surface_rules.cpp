#include "rigid/batch/surface_rules.h"

#include "geometry/query/closest_points.h"
#include "geometry/shape/mesh.h"

namespace gyre {

namespace {

// Least cosine of the angle between normal and surface direction at which a one-way surface stops a body.
constexpr float kHolds = 0.5f;
// In sizes of the passing body. A deeper body is passing through. A body that goes farther in a step is fast and is swept, so none from the
// other side gets so deep.
constexpr float kPassingDepth = 0.5f;
// As a share of the speed of a fall by the body's size. A body that overlaps and leaves faster is passing through.
constexpr float kLeaving = 0.05f;

const SurfaceRule* find_rule(const RigidWorld& w, std::uint16_t id) {
  if (id == 0) return nullptr;
  for (const SurfaceRule& rule : w.surface_rules) {
    if (rule.id == id) return &rule;
  }
  return nullptr;
}

Pose pose_of_shape(const RigidWorld& w, std::uint32_t shape) {
  return origin_pose(w.bodies, w.shapes.bodies[shape]) * w.shapes.body_from_shape[shape];
}

// Returns the triangle of a mesh or height field nearest to a point, as the user numbers it.
std::uint32_t nearest_triangle(const RigidWorld& w, std::uint32_t shape, DVec3 place) {
  const Pose pose = pose_of_shape(w, shape);
  const DQuat orientation = normalized(to_double(pose.orientation));
  Shape point;
  point.radius = 0.0f;
  ClosestPair near;
  const PosedShape placed{&point, rotate_inverse(orientation, place - pose.position), {}};
  find_closest_points(w.shapes.colliders[shape].shape, placed, double(kUnbounded), near);
  return near.triangle;
}

DVec3 deepest_place(const RigidWorld& w, const Contact& contact, const Manifold& manifold) {
  int deepest = 0;
  for (int k = 1; k < manifold.count; ++k) {
    if (manifold.points[k].separation < manifold.points[deepest].separation) deepest = k;
  }
  return w.bodies.poses[contact.body_a].center + manifold.points[deepest].from_a;
}

// One side of a contact.
struct Side {
  const SurfaceRule* rule = nullptr;
  const Material* material = nullptr;
  bool of_triangle = false;  // the triangle has its own material
};

Side side_of(const RigidWorld& w, std::uint32_t shape, const Contact& contact, const Manifold& manifold) {
  const Shape& form = w.shapes.colliders[shape].shape;
  Side side;
  side.material = &w.shapes.materials[shape];
  if (form.kind == ShapeKind::mesh && !form.mesh->materials.empty()) {
    const std::uint32_t triangle = nearest_triangle(w, shape, deepest_place(w, contact, manifold));
    const std::uint16_t id = triangle == kNoTriangle ? std::uint16_t{0} : form.mesh->materials[triangle];
    side.rule = find_rule(w, id);
    side.of_triangle = side.rule != nullptr;
    if (side.of_triangle) side.material = &side.rule->material;
  }
  if (side.rule == nullptr) side.rule = find_rule(w, side.material->id);
  return side;
}

Vec3 turn_to_world(const RigidWorld& w, std::uint32_t body, Vec3 v) {
  return rotate(w.bodies.poses[body].orientation, v);
}

float size_of(const RigidWorld& w, std::uint32_t shape, const Contact& contact) {
  const float size = w.shapes.colliders[shape].size;
  return size > 0.0f && size < kUnbounded ? size : contact.size;
}

// True if a one-way surface stops the other body. `direction`: of the surface, world axes; `outward`: the manifold's normal, out of the
// surface; `leaving`: the other body's relative velocity; `size`: of the other shape.
bool holds(const Manifold& manifold, Vec3 direction, Vec3 outward, Vec3 leaving, float size, float gravity) {
  const Vec3 along = normalized(direction);
  if (dot(along, outward) < kHolds) return false;
  float deepest = kUnbounded;
  for (int k = 0; k < manifold.count; ++k) deepest = min(deepest, manifold.points[k].separation);
  if (deepest < -kPassingDepth * size) return false;
  return deepest >= 0.0f || dot(leaving, along) <= kLeaving * std::sqrt(gravity * size);
}

void clear_impulses(Manifold& manifold) {
  for (int k = 0; k < manifold.count; ++k) {
    manifold.points[k].normal_impulse = 0.0f;
    manifold.points[k].mean_impulse = 0.0f;
  }
  manifold.friction_impulse = {};
  manifold.rolling_impulse = {};
  manifold.twist_impulse = 0.0f;
  manifold.load_age = 0.0f;
  manifold.sliding = 0;
}

}  // namespace

bool apply_surface_rules(const RigidWorld& w, const Contact& contact, Manifold& manifold,
                         ContactConstraint& constraint) {
  const Side a = side_of(w, contact.shape_a, contact, manifold);
  const Side b = side_of(w, contact.shape_b, contact, manifold);
  if (a.rule == nullptr && b.rule == nullptr) return true;
  const Vec3 speed = point_velocity(w.bodies.motion[contact.body_b], manifold.points[0].from_b) -
                     point_velocity(w.bodies.motion[contact.body_a], manifold.points[0].from_a);
  const float gravity = reference_gravity(w.settings);
  Vec3 running;
  if (a.rule != nullptr) {
    const Vec3 one_way = turn_to_world(w, contact.body_a, a.rule->one_way);
    if (a.rule->one_way != Vec3{} &&
        !holds(manifold, one_way, manifold.normal, speed, size_of(w, contact.shape_b, contact), gravity)) {
      clear_impulses(manifold);
      return false;
    }
    running += turn_to_world(w, contact.body_a, a.rule->velocity);
  }
  if (b.rule != nullptr) {
    const Vec3 one_way = turn_to_world(w, contact.body_b, b.rule->one_way);
    if (b.rule->one_way != Vec3{} &&
        !holds(manifold, one_way, -manifold.normal, -speed, size_of(w, contact.shape_a, contact), gravity)) {
      clear_impulses(manifold);
      return false;
    }
    running -= turn_to_world(w, contact.body_b, b.rule->velocity);
  }
  // B rests on A if it moves with A's surface while its own surface does not run.
  constraint.surface_velocity = running - dot(running, manifold.normal) * manifold.normal;
  if (a.of_triangle || b.of_triangle) {
    const ContactSurface surface = combine_materials(w, *a.material, *b.material);
    constraint.static_friction = surface.static_friction;
    constraint.dynamic_friction = surface.dynamic_friction;
    constraint.rolling_friction = surface.rolling_friction;
    constraint.spinning_friction = surface.spinning_friction;
    constraint.restitution = surface.restitution;
  }
  return true;
}

bool lets_pass(const RigidWorld& w, std::uint32_t shape, Vec3 way) {
  const SurfaceRule* const rule = find_rule(w, w.shapes.materials[shape].id);
  return rule != nullptr && dot(turn_to_world(w, w.shapes.bodies[shape], rule->one_way), way) > 0.0f;
}

std::int32_t triangle_at(const RigidWorld& w, const Contact& contact, DVec3 place) {
  for (const std::uint32_t shape : {contact.shape_a, contact.shape_b}) {
    const ShapeKind kind = w.shapes.colliders[shape].shape.kind;
    if (kind != ShapeKind::mesh && kind != ShapeKind::height_field) continue;
    return std::int32_t(nearest_triangle(w, shape, place));
  }
  return -1;
}

}  // namespace gyre
