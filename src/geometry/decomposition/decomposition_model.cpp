// Welding, winding, grouping and thickening. See decomposition_model.h.
#include "geometry/decomposition/decomposition_model.h"

#include "base/container/flat_map.h"
#include "geometry/decomposition/convex_body.h"
#include "geometry/mass/closed_surface.h"
#include "geometry/shape/flat_triangles.h"
#include "geometry/shape/mesh_weld.h"

#include <gyre/bounds.h>

#include <utility>

namespace gyre {
namespace {

constexpr float kMinMesh = 1.0e-6f, kMaxMesh = 1.0e9f;  // m

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t(min(a, b)) << 32 | max(a, b);
}

FlatMap<EdgeUse> find_edges(const Model& model) {
  FlatMap<EdgeUse> edges;
  edges.reserve(model.indices.size() / 2);
  for (std::uint32_t t = 0; t < model.triangle_count(); ++t) {
    const std::uint32_t* const v = model.indices.data() + 3 * std::size_t(t);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = v[i], to = v[(i + 1) % 3];
      EdgeUse& use = edges.find_or_insert(edge_key(from, to));
      if (use.forward + use.backward == 0) use.first = t;
      use.last = t;
      ++(from < to ? use.forward : use.backward);
    }
  }
  return edges;
}

// Disjoint sets of connected elements.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = std::uint32_t(i);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The lower one becomes the root.
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[max(a, b)] = min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

Error check_input(const DecompositionDef& def) {
  const TriangleSurface surface{def.vertices, def.indices, {}, {}};
  if (const Error error = check_surface_data(surface)) return error;
  for (std::size_t i = 0; i < def.vertices.size(); ++i) {
    const Vec3 p = def.vertices[i];
    if (!is_finite(p) || max(absolute(p.x), max(absolute(p.y), absolute(p.z))) > kMaxMesh) {
      return make_error(
          ErrorCode::invalid_geometry,
          "decomposition: vertex %zu is (%g, %g, %g); allowed are finite coordinates within -%g to %g m", i,
          double(p.x), double(p.y), double(p.z), double(kMaxMesh), double(kMaxMesh));
    }
  }
  return {};
}

// Copies welded vertices that are used, and triangles with an area.
void load_triangles(const DecompositionDef& def, Model& model) {
  const std::vector<std::uint32_t> welded = weld_vertices(def.vertices, def.indices);
  Vec3 low = def.vertices[def.indices[0]], high = low;
  for (const std::uint32_t i : def.indices) {
    low = min(low, def.vertices[i]);
    high = max(high, def.vertices[i]);
  }
  const DVec3 extent = DVec3(high) - DVec3(low);
  const double longest = max(extent.x, max(extent.y, extent.z));
  model.origin = DVec3(low);
  model.scale = 1.0;
  // The scale is a power of two, so that conversion does not round.
  while (longest * model.scale > 1.0) model.scale *= 0.5;
  while (longest > 0.0 && longest * model.scale <= 0.5) model.scale *= 2.0;

  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> number(def.vertices.size(), kNone);
  const TriangleList triangles = without_flat_triangles(def.vertices, def.indices, welded);
  model.findings.degenerate_triangles = std::uint32_t(def.indices.size() / 3 - triangles.source.size());
  for (std::size_t t = 0; t < triangles.indices.size(); t += 3) {
    DVec3 p[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = triangles.indices[t + i];
      p[i] = model.scale * (DVec3(def.vertices[v]) - model.origin);
      if (number[v] == kNone) {
        number[v] = std::uint32_t(model.vertices.size());
        model.vertices.push_back(p[i]);
      }
      model.indices.push_back(number[v]);
    }
    model.area += 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
  }
}

void count_edges(Model& model) {
  const FlatMap<EdgeUse> edges = find_edges(model);
  for (const auto& [key, use] : edges.entries()) {
    const std::uint32_t count = use.forward + use.backward;
    if (count == 1) ++model.findings.open_edges;
    if (count > 2) ++model.findings.non_manifold_edges;
  }
}

double signed_volume(const Model& model, std::size_t t) {
  return dot(model.corner(t, 0), cross(model.corner(t, 1), model.corner(t, 2))) / 6.0;
}

// Triangles that are connected through vertices.
struct Piece {
  double volume = 0.0;
  DVec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  std::uint32_t triangles = 0;
  std::uint32_t group = 0;
  bool closed = true;
  bool cavity = false;

  bool contains(const Piece& other) const {
    return low.x <= other.low.x && low.y <= other.low.y && low.z <= other.low.z && other.high.x <= high.x &&
           other.high.y <= high.y && other.high.z <= high.z;
  }
};

std::vector<Piece> find_pieces(Model& model, std::vector<std::uint32_t>& piece_of) {
  UnionFind unions(model.vertices.size());
  for (std::size_t i = 0; i < model.indices.size(); i += 3) {
    unions.join(model.indices[i], model.indices[i + 1]);
    unions.join(model.indices[i], model.indices[i + 2]);
  }
  std::vector<std::uint32_t> number(model.vertices.size(), 0xffffffffu);
  std::vector<Piece> pieces;
  piece_of.resize(model.triangle_count());
  for (std::size_t t = 0; t < model.triangle_count(); ++t) {
    std::uint32_t& slot = number[unions.find(model.indices[3 * t])];
    if (slot == 0xffffffffu) {
      slot = std::uint32_t(pieces.size());
      pieces.emplace_back();
    }
    piece_of[t] = slot;
    Piece& piece = pieces[slot];
    ++piece.triangles;
    piece.volume += signed_volume(model, t);
    for (std::size_t i = 0; i < 3; ++i) {
      piece.low = lower(piece.low, model.corner(t, i));
      piece.high = higher(piece.high, model.corner(t, i));
    }
  }
  const FlatMap<EdgeUse> edges = find_edges(model);
  for (const auto& [key, use] : edges.entries()) {
    if (use.forward != use.backward) pieces[piece_of[use.first]].closed = false;
  }
  return pieces;
}

void flip(Model& model, std::size_t t) {
  std::swap(model.indices[3 * t + 1], model.indices[3 * t + 2]);
  ++model.findings.flipped_triangles;
}

}  // namespace

double enclosed_volume(const Model& model) {
  double volume = 0.0;
  for (std::size_t t = 0; t < model.triangle_count(); ++t) volume += signed_volume(model, t);
  return volume;
}

std::uint32_t wind_alike(Model& model) {
  const FlatMap<EdgeUse> edges = find_edges(model);
  const std::size_t count = model.triangle_count();
  std::vector<signed char> winding(count, 0);  // 1: unchanged, -1: to be flipped
  std::vector<std::uint32_t> surface;
  std::vector<std::uint32_t> flipped;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    if (winding[seed] != 0) continue;
    winding[seed] = 1;
    surface.assign(1, seed);
    double same_area = 0.0, opposite_area = 0.0;
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const std::uint32_t t = surface[i];
      const double area =
          length(cross(model.corner(t, 1) - model.corner(t, 0), model.corner(t, 2) - model.corner(t, 0)));
      (winding[t] > 0 ? same_area : opposite_area) += area;
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t from = model.indices[3 * std::size_t(t) + e];
        const std::uint32_t to = model.indices[3 * std::size_t(t) + (e + 1) % 3];
        const EdgeUse& use = *edges.find(edge_key(from, to));
        if (use.forward + use.backward != 2) continue;
        const std::uint32_t other = use.first == t ? use.last : use.first;
        if (other == t || winding[other] != 0) continue;
        winding[other] = use.forward == 1 ? winding[t] : static_cast<signed char>(-winding[t]);
        surface.push_back(other);
      }
    }
    const signed char wrong = same_area >= opposite_area ? -1 : 1;
    for (const std::uint32_t t : surface) {
      if (winding[t] == wrong) flipped.push_back(t);
    }
  }
  for (const std::uint32_t t : flipped) flip(model, t);
  return std::uint32_t(flipped.size());
}

void group_solids(Model& model) {
  std::vector<std::uint32_t> piece_of;
  std::vector<Piece> pieces = find_pieces(model, piece_of);
  model.closed = true;
  for (const Piece& piece : pieces) model.closed = model.closed && piece.closed;
  // Very many pieces count as one heap, because nobody wants a hull for each.
  constexpr std::size_t kMany = 256;
  model.group.assign(model.triangle_count(), 0);
  model.group_count = 1;
  std::vector<std::uint8_t> inside_out(pieces.size(), 0);
  for (std::size_t i = 0; i < pieces.size() && pieces.size() <= kMany; ++i) {
    Piece& piece = pieces[i];
    if (!piece.closed || piece.volume >= 0.0) continue;
    for (const Piece& other : pieces)
      piece.cavity = piece.cavity || (other.volume > 0.0 && other.contains(piece));
    inside_out[i] = piece.cavity ? 0 : 1;
  }
  if (pieces.size() > kMany) {
    double volume = 0.0;
    for (const Piece& piece : pieces) volume += piece.volume;
    for (std::uint8_t& flag : inside_out) flag = volume < 0.0 ? 1 : 0;
  }
  for (std::size_t t = 0; t < model.triangle_count(); ++t) {
    if (inside_out[piece_of[t]] != 0) flip(model, t);
  }
  if (pieces.size() > kMany) return;
  model.group_count = 0;
  for (Piece& piece : pieces) {
    if (!piece.cavity) piece.group = model.group_count++;
  }
  for (Piece& piece : pieces) {
    if (!piece.cavity) continue;
    double best = 1.0e300;
    for (const Piece& other : pieces) {
      if (other.cavity || !other.contains(piece) || !(absolute(other.volume) < best)) continue;
      best = absolute(other.volume);
      piece.group = other.group;
    }
  }
  for (std::size_t t = 0; t < model.triangle_count(); ++t) model.group[t] = pieces[piece_of[t]].group;
}

void thicken(Model& model, double half) {
  const FlatMap<EdgeUse> edges = find_edges(model);
  const std::size_t count = model.triangle_count();
  std::vector<DVec3> normals(model.vertices.size());
  for (std::size_t t = 0; t < count; ++t) {
    const DVec3 n = cross(model.corner(t, 1) - model.corner(t, 0), model.corner(t, 2) - model.corner(t, 0));
    for (std::size_t i = 0; i < 3; ++i) normals[model.indices[3 * t + i]] += n / length(n);
  }
  const std::uint32_t below = std::uint32_t(model.vertices.size());
  std::vector<DVec3> vertices(2 * normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double size = length(normals[i]);
    const DVec3 n = size > 1.0e-6 ? normals[i] / size : DVec3{0, 1, 0};
    vertices[i] = model.vertices[i] + half * n;
    vertices[below + i] = model.vertices[i] - half * n;
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(2 * model.indices.size());
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c}) indices.push_back(v);
  };
  for (std::size_t t = 0; t < count; ++t) {
    const std::uint32_t* const v = model.indices.data() + 3 * t;
    add(v[0], v[1], v[2]);
    add(below + v[0], below + v[2], below + v[1]);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = v[i], to = v[(i + 1) % 3];
      const EdgeUse& use = *edges.find(edge_key(from, to));
      // Two triangles that are wound alike have no wall between them.
      if (use.forward == 1 && use.backward == 1) continue;
      add(from, below + from, below + to);
      add(from, below + to, to);
    }
  }
  model.vertices = std::move(vertices);
  model.indices = std::move(indices);
  model.closed = false;  // walls may lack where the winding changes
  model.area = 0.0;
  for (std::size_t t = 0; t < model.triangle_count(); ++t)
    model.area +=
        0.5 * length(cross(model.corner(t, 1) - model.corner(t, 0), model.corner(t, 2) - model.corner(t, 0)));
}

Result<Model> make_model(const DecompositionDef& def) {
  if (const Error error = check_input(def)) return error;
  Model model;
  load_triangles(def, model);
  if (model.indices.empty()) {
    return make_error(ErrorCode::invalid_geometry,
                      "decomposition: none of %zu triangles has an area; allowed are meshes that have one",
                      def.indices.size() / 3);
  }
  std::vector<Vec3> points;
  for (const DVec3& p : model.vertices) points.push_back(to_float(p));
  const Result<BoundingSphere> sphere = fit_sphere(points);
  if (!sphere) return sphere.error();
  model.size = 2.0 * double(sphere->radius);
  if (!(model.size / model.scale >= double(kMinMesh))) {
    return make_error(ErrorCode::invalid_geometry,
                      "decomposition: the mesh is %g m large; allowed are %g m and more",
                      model.size / model.scale, double(kMinMesh));
  }
  count_edges(model);
  wind_alike(model);
  group_solids(model);
  return model;
}

}  // namespace gyre
