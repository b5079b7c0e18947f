#include "bench/scenes/gyre_engine.h"

namespace gyre::bench {
namespace {

DVec3 place(V3 v) { return {v.x, v.y, v.z}; }
gyre::Vec3 narrow(V3 v) { return {float(v.x), float(v.y), float(v.z)}; }
gyre::Quat narrow(Quat q) { return {float(q.x), float(q.y), float(q.z), float(q.w)}; }
V3 widen(gyre::Vec3 v) { return {double(v.x), double(v.y), double(v.z)}; }

BodyType type_of(Motion motion) {
  if (motion == Motion::fixed) return BodyType::fixed;
  return motion == Motion::kinematic ? BodyType::kinematic : BodyType::dynamic;
}

JointDef definition_of(const Joint& joint, BodyId a, BodyId b) {
  const DVec3 anchor = place(joint.anchor);
  const Vec3 axis = narrow(joint.axis);
  const Limits limits{float(joint.lo), float(joint.hi)};
  switch (joint.kind) {
    case JointKind::ball:
      return BallDef{.a = a, .b = b, .anchor = anchor};
    case JointKind::cone:
      return ConeDef{
          .a = a, .b = b, .anchor = anchor, .axis = axis, .swing_y = float(joint.cone), .limits = limits};
    case JointKind::hinge:
      break;
  }
  return HingeDef{.a = a, .b = b, .anchor = anchor, .axis = axis, .limits = limits};
}

Filter filter_of(Layer layer) {
  if (layer == Layer::fixed) return {.layer = 1};
  if (layer == Layer::normal) return {.layer = 2};
  return {.layer = 4, .collides_with = 3};
}

}  // namespace

bool GyreEngine::cook(const Scene& scene, std::string& why_not) {
  for (const Hull& hull : scene.hulls) {
    std::vector<gyre::Vec3> points;
    for (const V3& v : hull.v) points.push_back(narrow(v));
    Result<Geometry> cooked = cook_hull(points);
    if (!cooked) return why_not = cooked.error().message, false;
    hulls_.push_back(*std::move(cooked));
  }
  for (const Mesh& mesh : scene.meshes) {
    std::vector<gyre::Vec3> vertices;
    for (const V3& v : mesh.v) vertices.push_back(narrow(v));
    const std::vector<std::uint32_t> indices(mesh.tri.begin(), mesh.tri.end());
    Result<Geometry> cooked = cook_mesh({.vertices = vertices, .indices = indices});
    if (!cooked) return why_not = cooked.error().message, false;
    meshes_.push_back(*std::move(cooked));
  }
  return true;
}

AnyShape GyreEngine::geometry_of(const Shape& shape) const {
  switch (shape.kind) {
    case Kind::sphere:
      return Sphere{float(shape.radius)};
    case Kind::capsule:
      return Capsule{float(shape.radius), float(shape.half_length)};
    case Kind::box:
      return Box{narrow(shape.half)};
    case Kind::hull:
      return hulls_[std::size_t(shape.data)];
    case Kind::mesh:
      return meshes_[std::size_t(shape.data)];
  }
  return Sphere{};
}

void GyreEngine::add_bodies(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    std::vector<ShapeDef> shapes;
    for (const Shape& shape : body.shapes) {
      ShapeDef def;
      def.geometry = geometry_of(shape);
      def.local = {narrow(shape.local.p), narrow(shape.local.q)};
      def.density = float(body.density);
      def.material.static_friction = def.material.dynamic_friction = float(scene.friction);
      def.material.restitution = float(scene.restitution);
      def.filter = filter_of(body.layer);
      shapes.push_back(def);
    }
    BodyDef def;
    def.type = type_of(body.motion);
    def.pose = {place(body.pos), narrow(body.q)};
    def.linear_velocity = narrow(body.vel);
    def.angular_velocity = narrow(body.ang);
    ids_.push_back(world_->add_body(def, shapes));
  }
}

void GyreEngine::add_joints(const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    world_->add_joint(definition_of(joint, ids_[std::size_t(joint.a)], ids_[std::size_t(joint.b)]));
  }
}

bool GyreEngine::create(const Scene& scene, int threads, bool sleep, std::string& why_not) {
  WorldDef def;
  def.gravity = {0, float(scene.gravity), 0};
  def.threads = threads;
  def.sleeping = sleep;
  def.stepping.substeps = substeps_;
  Result<World> world = World::create(def);
  if (!world) return why_not = world.error().message, false;
  world_ = *std::move(world);
  if (!cook(scene, why_not)) return false;
  add_bodies(scene);
  add_joints(scene);
  for (const Problem& problem : world_->problems()) return why_not = problem.message, false;
  return true;
}

BodyState GyreEngine::state(int body) {
  const BodyId id = ids_[std::size_t(body)];
  const gyre::Pose pose = world_->pose(id);
  const gyre::Quat q = pose.orientation;
  return {{{pose.position.x, pose.position.y, pose.position.z},
           {double(q.x), double(q.y), double(q.z), double(q.w)}},
          widen(world_->linear_velocity(id)),
          widen(world_->angular_velocity(id)),
          !world_->is_awake(id)};
}

bool GyreEngine::cast_ray(V3 from, V3 by, double& fraction) {
  const std::optional<CastHit> hit = world_->cast_ray(place(from), narrow(by));
  if (hit) fraction = hit->fraction;
  return hit.has_value();
}

}  // namespace gyre::bench
