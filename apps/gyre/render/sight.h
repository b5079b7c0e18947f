// What there is to see at one moment, whether it comes from a world that is simulated or from a file.
#pragma once

#include "render/fluid_sight.h"
#include "render/soft_reading.h"
#include "scene/scene.h"

#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/soft.h>
#include <gyre/world.h>

#include <cstddef>
#include <span>
#include <vector>

namespace gyre {

struct SeenShape {
  const AnyShape* geometry = nullptr;
  Transform local{};  // body_from_shape
  SceneColor color{};
  bool sensor = false;
};

struct SeenBody {
  BodyId id{};
  BodyType type = BodyType::dynamic;
  Pose pose{};  // world_from_body
  std::size_t first_shape = 0, shape_count = 0;
};

// A rod, rope or spring.
struct SeenLink {
  DVec3 a, b;
  float length = 0.0f;  // m, of a rope, which sags if it is longer than the way; 0: straight
  bool spring = false;
};

// A rope, cloth or solid.
struct SeenSoft {
  SoftId id{};
  SoftKind kind = SoftKind::rope;
  float radius = 0.0f;                         // m: that of a rope, half the thickness of a cloth
  std::span<const std::uint32_t> triangles{};  // those of the world or the file
  std::size_t first_vertex = 0, vertex_count = 0;
  SceneColor color{};
  std::vector<float> readings{};  // by vertex; none: it has its own colour
};

struct Sight {
  std::vector<SeenBody> bodies;  // in order of their ids
  std::vector<SeenShape> shapes;
  std::vector<SeenLink> links;
  std::vector<SeenSoft> softs;
  std::vector<DVec3> vertices;  // of the softs
  std::vector<SeenFluid> fluids;
  Vec3 down{0, -1, 0};  // unit

  std::span<const SeenShape> shapes_of(const SeenBody& body) const {
    return {shapes.data() + body.first_shape, body.shape_count};
  }
  std::span<const DVec3> vertices_of(const SeenSoft& soft) const {
    return {vertices.data() + soft.first_vertex, soft.vertex_count};
  }
};

// Looks at a world. `scene` (may be null) tells colours, sensors and which rods are springs; `bodies` are the world's bodies in its
// order. The geometries stay the world's. A solid is seen as the surface it was made of, or where stress or strain is read as that of its elements.
void look_at(const World& world, const Scene* scene, std::span<const BodyId> bodies, SoftReading reading,
             Sight& out);

}  // namespace gyre
