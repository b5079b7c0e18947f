// Shapes of glTF. The formats: Khronos Group, drafts of KHR_implicit_shapes and KHR_physics_rigid_bodies. See gltf_shapes.h.
#include "formats/gltf_shapes.h"

namespace gyre {
namespace {

// A capsule or cylinder whose ends have different radii, as points of its hull.
std::vector<Vec3> tapered_points(float bottom, float top, float half, bool round) {
  std::vector<Vec3> points;
  constexpr int kAround = 16, kRings = 4;
  for (const float side : {-1.0f, 1.0f}) {
    const float radius = side < 0 ? bottom : top;
    for (int ring = 0; ring < (round ? kRings : 1); ++ring) {
      const SinCos tilt = sin_cos(0.5f * kPi * float(ring) / float(kRings));
      for (int k = 0; k < kAround; ++k) {
        const SinCos turn = sin_cos(2.0f * kPi * float(k) / float(kAround));
        points.push_back({radius * tilt.cos * turn.cos, side * (half + (round ? radius * tilt.sin : 0.0f)),
                          radius * tilt.cos * turn.sin});
      }
    }
    if (round) points.push_back({0, side * (half + radius), 0});
  }
  return points;
}

}  // namespace

GltfPlace place_of(const GltfNode& node) {
  GltfPlace out;
  if (node.pose) {
    out.pose = *node.pose;
    return out;
  }
  const Mat3& m = node.linear;
  out.scale = {length(m.x), length(m.y), length(m.z)};
  const Vec3 x = normalized(m.x);
  const Vec3 y = normalized(m.y - dot(m.y, x) * x, any_perpendicular(x));
  const bool mirrored = determinant(m) < 0.0f;
  // A mirrored frame is turned over along x, which leaves a rotation.
  if (mirrored) out.scale.x = -out.scale.x;
  const Vec3 right = mirrored ? -x : x;
  out.pose = {node.translation, normalized(from_matrix({right, y, cross(right, y)}))};
  return out;
}

const Json& GltfShapes::implicit_shape(std::int64_t index, const std::string& pointer) const {
  for (const char* name : {"KHR_implicit_shapes", "KHR_collision_shapes"}) {
    const Json* const extension = document_.root_extension(name);
    const Json* const shapes = extension == nullptr ? nullptr : json_member(*extension, "shapes");
    if (shapes == nullptr || !shapes->is_array()) continue;
    if (index >= 0 && std::size_t(index) < shapes->size()) return (*shapes)[std::size_t(index)];
  }
  document_.fail(pointer, "names shape " + std::to_string(index) + ", but there is no such shape");
}

std::optional<SceneGeometry> GltfShapes::implicit_geometry(const Json& shape, Vec3 scale, bool moving,
                                                           const std::string& pointer) {
  const std::string type = json_text(shape, "type", "");
  static const Json kNothing = Json::object();
  const Json* const given = json_member(shape, type.c_str());
  const Json& of = given == nullptr ? kNothing : *given;
  const Vec3 size = absolute(scale);
  const bool is_even = largest(size) - smallest(size) < 1.0e-4f * largest(size);
  if (type != "box" && type != "plane" && !is_even)
    import_.findings.left_out("scale of a " + type + " that differs between axes, taken as the largest");
  const double factor = double(largest(size));
  const auto above_zero = [&](const char* key, double otherwise) {
    const double value = json_number(of, key, otherwise);
    if (!(value > 0)) document_.fail(pointer + "/" + key, "expected a number above 0");
    return float(value * factor);
  };
  if (type == "sphere") return Sphere{above_zero("radius", 0.5)};
  if (type == "box") {
    const auto edges = json_numbers(of, "size", 3);
    const Vec3 box = edges.empty() ? Vec3{1, 1, 1} : Vec3{float(edges[0]), float(edges[1]), float(edges[2])};
    if (!(smallest(box) > 0.0f)) document_.fail(pointer + "/size", "expected numbers above 0");
    return Box{0.5f * multiply_each(size, box)};
  }
  if (type == "capsule" || type == "cylinder") {
    const float half = 0.5f * above_zero("height", 0.5);
    const auto radius = [&](const char* key) {
      const double value = json_number(of, key, 0.25);
      if (!(value >= 0)) document_.fail(pointer + "/" + key, "expected a number of at least 0");
      return float(value * factor);
    };
    const float bottom = radius("radiusBottom"), top = radius("radiusTop");
    if (!(max(bottom, top) > 0.0f)) document_.fail(pointer, "expected a radius above 0");
    if (type == "cylinder" && top == 0.0f) return Cone{bottom, half};
    if (bottom != top) return SceneHull{tapered_points(bottom, top, half, type == "capsule"), -1};
    if (type == "capsule") return Capsule{top, half};
    return Cylinder{top, half};
  }
  if (type == "plane") {
    if (json_member(of, "sizeX") != nullptr || json_member(of, "sizeZ") != nullptr)
      import_.findings.left_out("size of a plane, taken as without end");
    if (!moving) return Plane{{0, 1, 0}, 0};
    import_.findings.left_out("plane on a moving body");
    return std::nullopt;
  }
  import_.findings.left_out("shape of type " + (type.empty() ? "none" : type));
  return std::nullopt;
}

Transform GltfShapes::local_at(int node, const Owner& owner) const {
  if (const auto rigid = document_.rigid_between(owner.node, node)) return *rigid;
  Transform out = inverse_times(owner.pose, place_of(document_.nodes()[std::size_t(node)]).pose);
  out.orientation = normalized(out.orientation);
  return out;
}

int GltfShapes::plain_mesh(std::int64_t mesh, const std::string& name) {
  const auto known = plain_meshes_.find(mesh);
  if (known != plain_meshes_.end()) return known->second;
  const int out = import_.add_mesh(document_.mesh_data(mesh), name);
  plain_meshes_.emplace(mesh, out);
  return out;
}

int GltfShapes::mesh_at(std::int64_t mesh, int node, const Owner& owner, Transform& local) {
  const GltfNode& at = document_.nodes()[std::size_t(node)];
  local = {};
  if (const auto rigid = document_.rigid_between(owner.node, node)) {
    local = *rigid;
    return plain_mesh(mesh, at.name);
  }
  MeshData data = document_.mesh_data(mesh);
  const Vec3 offset = difference(at.translation, owner.pose.position);
  for (Vec3& vertex : data.vertices) {
    vertex = rotate_inverse(owner.pose.orientation, at.linear * vertex + offset);
    if (!is_finite(vertex))
      document_.fail("/meshes/" + std::to_string(mesh), "has a position that is not finite once scaled");
  }
  if (determinant(at.linear) < 0.0f) {
    for (std::size_t i = 0; i + 2 < data.indices.size(); i += 3)
      std::swap(data.indices[i + 1], data.indices[i + 2]);
  }
  return import_.add_mesh(std::move(data), at.name);
}

std::optional<SceneShape> GltfShapes::shape_of(const Json& collider, int node, const Owner& owner,
                                               const std::string& pointer) {
  const Json* const nested = json_member(collider, "geometry");
  const Json& geometry = nested == nullptr ? collider : *nested;
  SceneShape out;
  bool hull = json_flag(geometry, "convexHull", false);
  std::int64_t mesh = json_integer(geometry, "mesh", -1);
  if (const std::int64_t source = json_integer(geometry, "node", -1); source >= 0) {
    if (std::size_t(source) >= document_.nodes().size())
      document_.fail(pointer, "names a node that does not exist");
    mesh = json_integer(document_.json()["nodes"][std::size_t(source)], "mesh", -1);
  }
  if (mesh < 0) {
    const Json& shape = implicit_shape(json_integer(geometry, "shape", -1), pointer);
    const std::string type = json_text(shape, "type", "");
    if (type == "mesh" || type == "convex") {  // of KHR_collision_shapes, an earlier draft
      const Json* const of = json_member(shape, type.c_str());
      mesh = of == nullptr ? -1 : json_integer(*of, "mesh", -1);
      hull = hull || type == "convex";
    } else {
      const GltfPlace place = place_of(document_.nodes()[std::size_t(node)]);
      const auto made = implicit_geometry(shape, place.scale, owner.moving, pointer);
      if (!made) return std::nullopt;
      out.geometry = *made;
      out.local = local_at(node, owner);
      return out;
    }
  }
  const int index = mesh_at(mesh, node, owner, out.local);
  if (hull) {
    SceneHull points;
    points.mesh = index;
    out.geometry = points;
    return out;
  }
  if (owner.moving && !import_.options.decompose)
    import_.findings.left_out("mesh on a moving body, taken as its convex hull");
  out.geometry = import_.solid_mesh(index, owner.moving);
  return out;
}

}  // namespace gyre
