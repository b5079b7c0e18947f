// Pairs half-edges, grows flat patches, marks edges. See mesh_topology.h.
#include "geometry/shape/mesh_topology.h"

#include "base/container/sort.h"

namespace gyre {
namespace {

// rad; a patch takes a neighbour whose normal deviates less than this from that of the patch,
constexpr float kPatchAngle = 2.0e-3f;
// and whose corners are within this of its plane, relative to the largest coordinate: a few units in the last place,
// the precision of float coordinates. The plane, not the angle, limits how far a finely divided curve counts as flat.
constexpr double kPatchTolerance = 4.0e-7;
// Cosine below which the two sides of a fold are back to back, and each has its own border.
constexpr float kFolded = -0.9999f;
constexpr std::uint32_t kNoPatch = 0xffffffffu;
// Edges with more triangles than this stay open.
constexpr std::size_t kMaxShared = 32;

std::uint32_t edge_start(const Mesh& mesh, std::uint32_t half_edge) { return mesh.indices[half_edge]; }
std::uint32_t edge_end(const Mesh& mesh, std::uint32_t half_edge) {
  return mesh.indices[half_edge / 3 * 3 + (half_edge + 1) % 3];
}

bool can_pair(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  // The same direction on both sides means that one of the triangles faces the other way.
  return edge_start(mesh, a) == edge_end(mesh, b) && dot(mesh.normals[a / 3], mesh.normals[b / 3]) > kFolded;
}

// If more than two triangles share an edge, the flattest pairs come first. Unpaired ones stay open.
void pair_shared(Mesh& mesh, const std::uint32_t* half_edges, std::size_t count) {
  if (count > kMaxShared) return;
  for (;;) {
    float best = -2.0f;
    std::uint32_t best_a = 0, best_b = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = i + 1; k < count; ++k) {
        const std::uint32_t a = half_edges[i], b = half_edges[k];
        if (mesh.twins[a] != Mesh::kNoTwin || mesh.twins[b] != Mesh::kNoTwin || !can_pair(mesh, a, b))
          continue;
        const float flatness = dot(mesh.normals[a / 3], mesh.normals[b / 3]);
        if (flatness > best) {
          best = flatness;
          best_a = a;
          best_b = b;
        }
      }
    }
    if (best < -1.5f) return;
    mesh.twins[best_a] = best_b;
    mesh.twins[best_b] = best_a;
  }
}

void pair_half_edges(Mesh& mesh) {
  const std::size_t count = mesh.indices.size();
  mesh.twins.assign(count, Mesh::kNoTwin);
  std::vector<std::uint64_t> keys(count), scratch_keys(count);
  std::vector<std::uint32_t> half_edges(count), scratch(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t a = edge_start(mesh, i), b = edge_end(mesh, i);
    keys[i] = min(a, b) << 32 | max(a, b);
    half_edges[i] = i;
  }
  radix_sort_pairs(keys, half_edges, scratch_keys, scratch);
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin + 1;
    while (end < count && keys[end] == keys[begin]) ++end;
    if (end - begin > 1) pair_shared(mesh, half_edges.data() + begin, end - begin);
    begin = end;
  }
}

// The plane of a patch: through the centre of its triangles, perpendicular to the sum of their areas. Both are refined
// while the patch grows, because the plane of one small triangle is no more precise than its rounded corners.
struct PatchPlane {
  DVec3 area;    // sum of area vectors
  DVec3 moment;  // sum of centres times areas
  double weight = 0.0;
  DVec3 normal, middle;

  void add(const Mesh& mesh, std::uint32_t triangle) {
    const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(triangle);
    const DVec3 a(mesh.vertices[corner[0]]), b(mesh.vertices[corner[1]]), c(mesh.vertices[corner[2]]);
    const DVec3 vector = cross(b - a, c - a);
    const double size = length(vector);
    area += vector;
    moment += (size / 3.0) * (a + b + c);
    weight += size;
  }
  void refine() {
    normal = area / length(area);
    middle = moment / weight;
  }
  double distance(Vec3 point) const { return absolute(dot(normal, DVec3(point) - middle)); }
};

// Grows the patch around one triangle: all connected triangles in one plane with it. They get one normal.
void grow_patch(Mesh& mesh, std::uint32_t seed, double tolerance, std::vector<std::uint32_t>& patch,
                std::vector<std::uint32_t>& members) {
  PatchPlane plane;
  plane.add(mesh, seed);
  plane.refine();
  members.assign(1, seed);
  patch[seed] = seed;
  std::size_t refined = 1;
  for (std::size_t next = 0; next < members.size(); ++next) {
    if (members.size() >= 2 * refined) {
      plane.refine();
      refined = members.size();
    }
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      const std::uint32_t twin = mesh.twins[3 * std::size_t(members[next]) + edge];
      if (twin == Mesh::kNoTwin || patch[twin / 3] != kNoPatch) continue;
      const std::uint32_t other = twin / 3;
      if (length_squared(mesh.normals[other] - to_float(plane.normal)) > kPatchAngle * kPatchAngle) continue;
      // The two corners on the shared edge were tested with the triangle on this side.
      const std::uint32_t apex = mesh.indices[3 * std::size_t(other) + (twin + 2) % 3];
      if (plane.distance(mesh.vertices[apex]) > tolerance) continue;
      patch[other] = seed;
      members.push_back(other);
      plane.add(mesh, other);
    }
  }
  if (members.size() == 1) return;
  plane.refine();
  for (const std::uint32_t member : members) mesh.normals[member] = to_float(plane.normal);
}

// Returns the patch of each triangle, named by its first triangle.
std::vector<std::uint32_t> grow_patches(Mesh& mesh) {
  const std::uint32_t count = mesh.triangle_count();
  const Vec3 largest_coordinates = max(absolute(mesh.tree.box.low), absolute(mesh.tree.box.high));
  const double tolerance = kPatchTolerance * double(largest(largest_coordinates));
  std::vector<std::uint32_t> patch(count, kNoPatch);
  std::vector<std::uint32_t> members;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    if (patch[seed] == kNoPatch) grow_patch(mesh, seed, tolerance, patch, members);
  }
  return patch;
}

void mark_edges(Mesh& mesh, const std::vector<std::uint32_t>& patch) {
  const std::uint32_t count = mesh.triangle_count();
  mesh.flags.assign(count, 0);
  std::vector<std::uint8_t> active(mesh.vertices.size(), 0);
  for (std::uint32_t half_edge = 0; half_edge < 3 * count; ++half_edge) {
    const std::uint32_t triangle = half_edge / 3, twin = mesh.twins[half_edge];
    EdgeKind kind = EdgeKind::open;
    const std::uint32_t from = edge_start(mesh, half_edge), to = edge_end(mesh, half_edge);
    if (twin != Mesh::kNoTwin) {
      const Vec3 along = mesh.vertices[to] - mesh.vertices[from];
      kind = patch[triangle] == patch[twin / 3]
                 ? EdgeKind::flat
                 : classify_edge(mesh.normals[triangle], mesh.normals[twin / 3], along, 0.0f);
    }
    mesh.flags[triangle] = std::uint16_t(mesh.flags[triangle] | unsigned(kind) << (2 * (half_edge % 3)));
    if (kind != EdgeKind::flat) active[from] = active[to] = 1;
  }
  for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
    unsigned flags = mesh.flags[triangle];
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
      const bool flat = active[mesh.indices[3 * std::size_t(triangle) + std::size_t(i)]] == 0;
      if (flat) flags |= 1u << (kFlatCornerShift + i);
      inside = inside && flat && edge_kind(mesh.flags[triangle], i) == EdgeKind::flat;
    }
    mesh.flags[triangle] = std::uint16_t(flags | (inside ? kInsidePatch : 0u));
  }
}

// Marks the lanes of the tree whose triangles all lie inside one patch. Children have higher indices than their
// parents.
void mark_lanes(Mesh& mesh, const std::vector<std::uint32_t>& patch) {
  constexpr std::uint32_t kMixed = 0xffffffffu;
  const std::size_t node_count = mesh.tree.nodes.size();
  mesh.flat_lanes.assign(node_count, 0);
  std::vector<std::uint32_t> node_patch(node_count, kMixed);
  for (std::size_t index = node_count; index-- > 0;) {
    const StaticTree::Node& node = mesh.tree.nodes[index];
    std::uint32_t common = kMixed;
    bool uniform = true;
    for (int lane = 0; lane < StaticTree::kWidth; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == StaticTree::kNoChild) continue;
      std::uint32_t found = kMixed;
      if (is_leaf(child)) {
        const std::uint32_t first = leaf_first(child), end = first + leaf_count(child);
        found = patch[first];
        for (std::uint32_t t = first; t < end; ++t) {
          if ((mesh.flags[t] & kInsidePatch) == 0 || patch[t] != patch[first]) found = kMixed;
        }
      } else {
        found = node_patch[child];
      }
      if (found != kMixed) mesh.flat_lanes[index] = std::uint8_t(mesh.flat_lanes[index] | 1u << lane);
      if (lane == 0) common = found;
      uniform = uniform && found == common;
    }
    node_patch[index] = uniform ? common : kMixed;
  }
}

}  // namespace

void connect_triangles(Mesh& mesh) {
  const std::uint32_t count = std::uint32_t(mesh.indices.size() / 3);
  mesh.normals.resize(count);
  for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
    const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(triangle);
    mesh.normals[triangle] =
        triangle_normal(mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]);
  }
  pair_half_edges(mesh);
  const std::vector<std::uint32_t> patch = grow_patches(mesh);
  mark_edges(mesh, patch);
  mark_lanes(mesh, patch);
}

}  // namespace gyre
