// What there is to see in a world. See sight.h.
#include "render/sight.h"

#include "scene/scene_color.h"

#include <gyre/debug.h>

namespace gyre {
namespace {

SeenShape look_at_shape(const World& world, ShapeId id, BodyType type, std::size_t ordinal) {
  const AnyShape* geometry = world.geometry(id);
  const bool plane = std::holds_alternative<Plane>(*geometry);
  return {geometry, world.local_transform(id), plane ? kGroundColor : automatic_color(type, ordinal)};
}

// Ropes and rods. Joints of a scene have its order as their indices, as nothing else was added before them.
void look_at_links(const World& world, const Scene* scene, Sight& out) {
  JointTable joints;
  const DVec3 origin = out.bodies.empty() ? DVec3{} : out.bodies[0].pose.position;
  read_joints(world, origin, joints);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints.kinds[i] != JointKind::distance) continue;
    const float* ends = &joints.anchors[6 * i];
    SeenLink link;
    link.a = origin + Vec3{ends[0], ends[1], ends[2]};
    link.b = origin + Vec3{ends[3], ends[4], ends[5]};
    constexpr float kNoEnd = 1e29f;
    if (joints.has_limits[i] && joints.limits[2 * i + 1] < kNoEnd) link.length = joints.limits[2 * i + 1];
    const std::size_t index = joints.ids[i].index;
    if (scene && index < scene->joints.size()) {
      const auto* const distance = std::get_if<DistanceDef>(&scene->joints[index].def);
      link.spring = distance != nullptr && distance->stiffness.has_value();
    }
    out.links.push_back(link);
  }
}

std::size_t count_of(const Scene& scene, SoftKind kind) {
  if (kind == SoftKind::rope) return scene.ropes.size();
  return kind == SoftKind::cloth ? scene.cloths.size() : scene.soft_bodies.size();
}

// Ropes, cloths and soft bodies of a scene carry their number among their kind as user data.
void look_at_softs(const World& world, const Scene* scene, SoftReading reading, Sight& out) {
  std::vector<SoftId> ids(world.softs({}));
  world.softs(ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const SoftInfo info = world.soft_info(ids[i]);
    const SoftVertices vertices = world.vertices(ids[i]);
    const bool known = scene && info.user_data < count_of(*scene, info.kind);
    const SceneColor color = known ? resolved_soft_color(*scene, info.kind, std::size_t(info.user_data))
                                   : automatic_color(BodyType::dynamic, i);
    SeenSoft soft{ids[i],          info.kind, info.radius, world.soft_triangles(ids[i]), out.vertices.size(),
                  vertices.size(), color,     read_by_vertex(world, ids[i], reading)};
    const std::size_t carried = reading == SoftReading::none ? world.soft_surface(ids[i], {}) : 0;
    if (carried > 0) {
      soft.triangles = world.soft_surface_triangles(ids[i]), soft.vertex_count = carried;
      out.vertices.resize(soft.first_vertex + carried);
      (void)world.soft_surface(ids[i], std::span(out.vertices).subspan(soft.first_vertex));
    } else {
      for (std::size_t k = 0; k < vertices.size(); ++k) out.vertices.push_back(vertices.position(k));
    }
    out.softs.push_back(std::move(soft));
  }
}

}  // namespace

void look_at(const World& world, const Scene* scene, std::span<const BodyId> bodies, SoftReading reading,
             Sight& out) {
  out.bodies.clear();
  out.shapes.clear();
  out.links.clear();
  out.softs.clear();
  out.vertices.clear();
  out.down = normalized(world.gravity(), Vec3{0, -1, 0});
  const BodyColumns all = world.bodies();
  for (std::size_t i = 0; i < all.ids.size(); ++i) {
    const BodyId id = all.ids[i];
    const std::span<const ShapeId> shapes = world.shapes(id);
    out.bodies.push_back({id, world.type(id), all.poses[i], out.shapes.size(), shapes.size()});
    // Bodies of a scene carry their number in it as user data.
    const std::uint64_t index = world.user_data(id);
    const bool known = scene && index < bodies.size() && bodies[index] == id;
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      SeenShape shape = look_at_shape(world, shapes[k], world.type(id), i);
      if (known && k < scene->bodies[index].shapes.size()) {
        shape.color = resolved_color(*scene, index, k);
        shape.sensor = scene->bodies[index].sensor;
      }
      out.shapes.push_back(shape);
    }
  }
  look_at_links(world, scene, out);
  look_at_softs(world, scene, reading, out);
  out.fluids = look_at_fluids(world, scene);
}

}  // namespace gyre
