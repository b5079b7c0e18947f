// Writes and reads cooked geometry. See geometry_codec.h.
#include "io/codec/geometry_codec.h"

#include "base/float_mode.h"
#include "base/container/sort.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/mesh.h"
#include "geometry/shape/mesh_topology.h"
#include "geometry/shape/triangle.h"
#include "io/codec/enum_counts.h"

namespace gyre {

namespace {

Error bad_geometry(const char* what) {
  return make_error(ErrorCode::invalid_data, "cooked geometry: %s", what);
}

std::span<const float> floats_of(std::span<const Vec3> vectors) {
  static_assert(sizeof(Vec3) == 3 * sizeof(float));
  return {vectors.empty() ? nullptr : &vectors.front().x, 3 * vectors.size()};
}

Vec3 get_vector(ByteReader& in) {
  Vec3 v;
  v.x = in.get<float>(), v.y = in.get<float>(), v.z = in.get<float>();
  return v;
}

std::vector<Vec3> get_vectors(ByteReader& in) {
  const std::vector<float> numbers = in.get_all<float>();
  if (numbers.size() % 3 != 0) in.fail();
  std::vector<Vec3> vectors(numbers.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i)
    vectors[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  return vectors;
}

bool all_finite(std::span<const Vec3> vectors) {
  for (const Vec3& v : vectors) {
    if (!is_finite(v)) return false;
  }
  return true;
}

// -------------------------------------------------------------------------------------------------------------- hulls

void write_hull(ByteWriter& out, const Hull& hull) {
  out.put_all(floats_of(hull.vertices));
  out.put_all(std::span<const std::uint32_t>(hull.face_offsets));
  out.put_all(std::span<const std::uint8_t>(hull.face_vertices));
  for (const HullPlane& plane : hull.planes) put_vector(out, plane.normal), out.put(plane.offset);
  out.put(std::uint64_t(hull.edges.size()));
  for (const HullEdge& edge : hull.edges)
    out.put(edge.from), out.put(edge.to), out.put(edge.left), out.put(edge.right);
  put_vector(out, hull.centroid);
  out.put(hull.inner_radius);
}

// Checks that each loop has at least three different corners, all of which exist.
bool faces_fit(const Hull& hull) {
  const std::size_t faces = hull.face_offsets.size() - 1;
  if (hull.face_offsets.front() != 0 || hull.face_offsets.back() != hull.face_vertices.size()) return false;
  for (std::size_t f = 0; f < faces; ++f) {
    const std::uint32_t begin = hull.face_offsets[f], end = hull.face_offsets[f + 1];
    if (end < begin || end - begin < 3 || end > hull.face_vertices.size()) return false;
  }
  for (const std::uint8_t vertex : hull.face_vertices) {
    if (vertex >= hull.vertices.size()) return false;
  }
  return true;
}

// Checks that every edge runs along the loop of its left face and back along that of its right face, and that the
// edges are all half-edges, each once.
bool edges_fit(const Hull& hull) {
  constexpr std::uint16_t kNone = 0xffff;
  std::vector<std::uint16_t> face_of(256 * 256, kNone);
  const auto half_edge = [&](std::uint8_t from, std::uint8_t to) -> std::uint16_t& {
    return face_of[std::size_t(from) * 256 + to];
  };
  for (std::size_t f = 0; f + 1 < hull.face_offsets.size(); ++f) {
    const std::uint32_t begin = hull.face_offsets[f], end = hull.face_offsets[f + 1];
    for (std::uint32_t i = begin; i < end; ++i) {
      std::uint16_t& face = half_edge(hull.face_vertices[i], hull.face_vertices[i + 1 < end ? i + 1 : begin]);
      if (face != kNone) return false;
      face = std::uint16_t(f);
    }
  }
  if (2 * hull.edges.size() != hull.face_vertices.size()) return false;
  for (const HullEdge& edge : hull.edges) {
    std::uint16_t& forward = half_edge(edge.from, edge.to);
    std::uint16_t& back = half_edge(edge.to, edge.from);
    if (forward != edge.left || back != edge.right || edge.left == edge.right) return false;
    forward = back = kNone;
  }
  return true;
}

Error read_hull(ByteReader& in, CookedGeometry& cooked) {
  auto hull = std::make_unique<Hull>();
  hull->vertices = get_vectors(in);
  hull->face_offsets = in.get_all<std::uint32_t>();
  hull->face_vertices = in.get_all<std::uint8_t>();
  const std::size_t faces = hull->face_offsets.empty() ? 0 : hull->face_offsets.size() - 1;
  if (in.failed() || hull->vertices.size() < 4 || hull->vertices.size() > 255 || faces < 4 || faces > 255) {
    return bad_geometry("a hull of an impossible size");
  }
  for (std::size_t f = 0; f < faces; ++f) {
    const Vec3 normal = get_vector(in);
    hull->planes.push_back({normal, in.get<float>()});
  }
  const std::size_t edges = in.get_count(4);
  for (std::size_t i = 0; i < edges; ++i) {
    HullEdge edge{};
    edge.from = in.get<std::uint8_t>(), edge.to = in.get<std::uint8_t>();
    edge.left = in.get<std::uint8_t>(), edge.right = in.get<std::uint8_t>();
    hull->edges.push_back(edge);
  }
  hull->centroid = get_vector(in);
  hull->inner_radius = in.get<float>();
  if (in.failed() || !faces_fit(*hull) || !edges_fit(*hull))
    return bad_geometry("a hull whose faces do not close");
  for (const HullPlane& plane : hull->planes) {
    if (!is_finite(plane.normal) || !is_finite(plane.offset))
      return bad_geometry("a hull with a plane that is not finite");
    if (absolute(length_squared(plane.normal) - 1.0f) > 1.0e-3f)
      return bad_geometry("a hull with a normal that is not a unit");
  }
  if (!all_finite(hull->vertices) || !is_finite(hull->centroid) || !(hull->inner_radius >= 0.0f) ||
      !is_finite(hull->inner_radius)) {
    return bad_geometry("a hull that is not finite");
  }
  complete_hull(*hull);
  cooked.hull = std::move(hull);
  return {};
}

// ------------------------------------------------------------------------------------------------------------- meshes

constexpr std::uint8_t kDoubleSided = 1, kHasMaterials = 2;

void write_mesh(ByteWriter& out, const Mesh& mesh) {
  // Before the flags, this byte was only the double-sidedness.
  out.put(
      std::uint8_t((mesh.double_sided ? kDoubleSided : 0) | (mesh.materials.empty() ? 0 : kHasMaterials)));
  out.put_all(floats_of(mesh.vertices));
  out.put_all(std::span<const std::uint32_t>(mesh.indices));
  out.put_all(std::span<const std::uint32_t>(mesh.source));
  if (!mesh.materials.empty()) out.put_all(std::span<const std::uint16_t>(mesh.materials));
}

// The triangles in the order of the cooked input: ascending `source`. False if two have the same.
bool order_by_source(std::span<const std::uint32_t> source, std::vector<std::uint32_t>& order) {
  std::vector<std::uint64_t> keys(source.size()), scratch(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) keys[i] = std::uint64_t(source[i]) << 32 | i;
  radix_sort_u64(keys, scratch);
  order.resize(source.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i > 0 && keys[i] >> 32 == keys[i - 1] >> 32) return false;
    order[i] = std::uint32_t(keys[i]);
  }
  return true;
}

// The tree over the triangles in input order sorts them into their stored order.
Error rebuild_tree(Mesh& mesh) {
  std::vector<std::uint32_t> order;
  if (!order_by_source(mesh.source, order)) return bad_geometry("a mesh with two triangles of one number");
  std::vector<Aabb> boxes(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) boxes[i] = triangle_box(mesh, order[i]);
  build_static_tree(boxes, mesh.tree);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[mesh.tree.items[i]] != i)
      return bad_geometry("a mesh whose triangles are not in the order of its tree");
  }
  mesh.tree.items = {};
  return {};
}

Error read_mesh(ByteReader& in, CookedGeometry& cooked) {
  auto mesh = std::make_unique<Mesh>();
  const auto bits = in.get<std::uint8_t>();
  if (bits > (kDoubleSided | kHasMaterials)) return bad_geometry("a mesh of an unknown kind");
  mesh->double_sided = (bits & kDoubleSided) != 0;
  mesh->vertices = get_vectors(in);
  mesh->indices = in.get_all<std::uint32_t>();
  mesh->source = in.get_all<std::uint32_t>();
  const std::size_t triangles = mesh->source.size();
  if ((bits & kHasMaterials) != 0) {
    mesh->materials = in.get_all<std::uint16_t>();
    for (const std::uint32_t triangle : mesh->source) {
      if (triangle >= mesh->materials.size()) return bad_geometry("a mesh with a triangle without material");
    }
  }
  if (in.failed() || triangles == 0 || triangles > StaticTree::kMaxItems ||
      mesh->indices.size() != 3 * triangles) {
    return bad_geometry("a mesh of an impossible size");
  }
  for (const Vec3& v : mesh->vertices) {
    if (!is_finite(v) || largest(absolute(v)) > kMaxSurfaceCoordinate)
      return bad_geometry("a mesh with a vertex out of range");
  }
  for (const std::uint32_t index : mesh->indices) {
    if (index >= mesh->vertices.size()) return bad_geometry("a mesh with an index out of range");
  }
  for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
    const std::uint32_t* corner = mesh->indices.data() + i;
    if (triangle_normal(mesh->vertices[corner[0]], mesh->vertices[corner[1]], mesh->vertices[corner[2]]) ==
        Vec3{}) {
      return bad_geometry("a mesh with a triangle without area");
    }
  }
  mesh->normals.resize(triangles);
  const Error e = rebuild_tree(*mesh);
  if (e) return e;
  connect_triangles(*mesh);
  cooked.mesh = std::move(mesh);
  return {};
}

// ------------------------------------------------------------------------------------------------------ height fields

void write_field(ByteWriter& out, const HeightField& field) {
  out.put(field.columns);
  out.put(field.rows);
  out.put(field.spacing);
  out.put_all(std::span<const float>(field.heights));
}

Result<Geometry> read_field(ByteReader& in) {
  HeightFieldDef def;
  def.columns = in.get<std::uint32_t>();
  def.rows = in.get<std::uint32_t>();
  def.spacing = in.get<float>();
  const std::vector<float> heights = in.get_all<float>();
  if (in.failed() || std::uint64_t(def.columns) * def.rows != heights.size()) {
    return bad_geometry("a height field of an impossible size");
  }
  def.heights = heights;
  return cook_height_field(def);
}

}  // namespace

bool GeometryTable::add(const Geometry& geometry) {
  if (!geometry || index_of_.contains(geometry.content_hash())) return false;
  index_of_.insert(geometry.content_hash(), std::uint32_t(items_.size()));
  items_.push_back(geometry);
  return true;
}

bool GeometryTable::add(const AnyShape& shape) {
  const Geometry* const cooked = std::get_if<Geometry>(&shape);
  return cooked != nullptr && add(*cooked);
}

const Geometry* GeometryTable::find(std::uint64_t content_hash) const {
  const std::uint32_t* const index = index_of_.find(content_hash);
  return index != nullptr ? &items_[*index] : nullptr;
}

void write_geometry(ByteWriter& out, const Geometry& geometry) {
  const CookedGeometry& data = *geometry.data();
  out.put(data.kind);
  out.put(data.content_hash);
  const std::size_t length_offset = out.size();
  out.put(std::uint64_t(0));
  if (data.kind == ShapeKind::hull) write_hull(out, *data.hull);
  if (data.kind == ShapeKind::mesh) write_mesh(out, *data.mesh);
  if (data.kind == ShapeKind::height_field) write_field(out, *data.field);
  out.patch(length_offset, std::uint64_t(out.size() - length_offset - sizeof(std::uint64_t)));
}

Result<Geometry> read_geometry(ByteReader& in, const GeometryTable& known) {
  const FloatMode mode;  // derived data is computed again
  const auto kind = in.get<ShapeKind>();
  const auto hash = in.get<std::uint64_t>();
  ByteReader body(in.get_bytes(in.get<std::uint64_t>()));
  if (in.failed()) return bad_geometry("it ends too soon");
  if (const Geometry* const found = known.find(hash); found != nullptr && found->kind() == kind)
    return *found;
  if (kind == ShapeKind::height_field) {
    const Result<Geometry> field = read_field(body);
    if (field && (!body.finished() || field->content_hash() != hash))
      return bad_geometry("a height field that is not what it says");
    return field;
  }
  auto cooked = std::make_shared<CookedGeometry>();
  cooked->kind = kind;
  cooked->content_hash = hash;
  Error e = bad_geometry("it is of no kind that is cooked");
  if (kind == ShapeKind::hull) e = read_hull(body, *cooked);
  if (kind == ShapeKind::mesh) e = read_mesh(body, *cooked);
  if (e) return e;
  if (!body.finished()) return bad_geometry("there is more than its parts take");
  return Geometry(std::shared_ptr<const CookedGeometry>(std::move(cooked)));
}

void write_geometry_table(ByteWriter& out, const GeometryTable& table) {
  out.put(std::uint64_t(table.items().size()));
  for (const Geometry& geometry : table.items()) write_geometry(out, geometry);
}

Error read_geometry_table(ByteReader& in, GeometryTable& table) {
  const std::size_t count = in.get_count(1 + 2 * sizeof(std::uint64_t));
  for (std::size_t i = 0; i < count; ++i) {
    const Result<Geometry> geometry = read_geometry(in, table);
    if (!geometry) return geometry.error();
    table.add(*geometry);
  }
  return in.failed() ? bad_geometry("the table ends too soon") : Error{};
}

void write_shape(ByteWriter& out, const AnyShape& shape) {
  static_assert(std::variant_size_v<AnyShape> == 7, "a new shape needs its lines here and in read_shape");
  out.put(std::uint8_t(shape.index()));
  if (const auto* sphere = std::get_if<Sphere>(&shape)) out.put(sphere->radius);
  if (const auto* box = std::get_if<Box>(&shape)) put_vector(out, box->half_extents), out.put(box->rounding);
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    out.put(capsule->radius), out.put(capsule->half_height);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    out.put(cylinder->radius), out.put(cylinder->half_height);
  if (const auto* cone = std::get_if<Cone>(&shape)) out.put(cone->radius), out.put(cone->half_height);
  if (const auto* plane = std::get_if<Plane>(&shape)) put_vector(out, plane->normal), out.put(plane->offset);
  if (const auto* cooked = std::get_if<Geometry>(&shape))
    out.put(*cooked ? cooked->content_hash() : std::uint64_t(0));
}

namespace {

// Capsule, cylinder and cone have the same two numbers.
template <class Round>
Round read_round(ByteReader& in) {
  Round shape;
  shape.radius = in.get<float>();
  shape.half_height = in.get<float>();
  return shape;
}

}  // namespace

AnyShape read_shape(ByteReader& in, const GeometryTable& table) {
  switch (in.get<std::uint8_t>()) {
    case 0:
      return Sphere{in.get<float>()};
    case 1: {
      Box box;
      box.half_extents = get_vector(in);
      box.rounding = in.get<float>();
      return box;
    }
    case 2:
      return read_round<Capsule>(in);
    case 3:
      return read_round<Cylinder>(in);
    case 4:
      return read_round<Cone>(in);
    case 5: {
      Plane plane;
      plane.normal = get_vector(in);
      plane.offset = in.get<float>();
      return plane;
    }
    case 6:
      if (const Geometry* const found = table.find(in.get<std::uint64_t>())) return *found;
      break;
    default:
      break;
  }
  in.fail();
  return Sphere{};
}

}  // namespace gyre
