// Gathering triangles near a convex shape. See mesh_candidates.h.
#include "geometry/manifold_mesh/mesh_candidates.h"

#include "base/container/sort.h"
#include "geometry/manifold_mesh/mesh_cull.h"

#include <bit>

namespace gyre {
namespace {

// Cells each way around a body that has too many triangles near it, and the triangles that each keeps.
constexpr int kCells = 8;
constexpr int kKept = 2;
constexpr int kKeptSlots = kCells * kCells * kCells * kKept;
// Of flat ground, those under corners of the shape in any case.
constexpr int kCornerSlots = MeshCandidates::kRoom - kKeptSlots;
static_assert(kCornerSlots >= 64);
// How far around a shape triangles are kept, by its size.
constexpr float kKeptMargin = 0.5f;
// So many parts of one flat patch stand for all of it.
constexpr int kStandIns = 64;

// Most triangles in a leaf are left out by nothing else.
AxisBox axis_box(const Mesh& mesh, std::uint32_t triangle) {
  const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(triangle);
  const Wide<4> a = AxisBox::lanes(mesh.vertices[corner[0]]), b = AxisBox::lanes(mesh.vertices[corner[1]]),
                c = AxisBox::lanes(mesh.vertices[corner[2]]);
  return {min(a, min(b, c)), max(a, max(b, c))};
}

// A cube well inside of what a shape reaches, in the surface's frame: what overlaps it need not be asked for more.
AxisBox inner_cube(const LocalConvex& convex, Vec3 position, float max_separation) {
  constexpr float kInBall = 0.57f;  // a cube's half side in a ball of radius 1
  const Aabb& local = convex.local_box();
  const float half =
      kInBall * (smallest(half_size(local)) + max_separation) - 1.0e-6f * largest(absolute(position));
  const Vec3 middle = convex.from_local(center(local)) + position;
  return AxisBox(grow({middle, middle}, max(half, 0.0f)));
}

class Gatherer {
 public:
  Gatherer(const MeshKernels& kernels, const Surface& surface, const LocalConvex& convex, Vec3 position,
           float max_separation, CachedTriangles* kept, MeshCandidates& out)
      : kernels_(kernels),
        surface_(surface),
        convex_(convex),
        position_(position),
        max_separation_(max_separation),
        kept_(kept),
        out_(out),
        inner_(inner_cube(convex, position, max_separation)) {
    const float rounding = 1.2e-7f * largest(absolute(position));
    box_ = grow(convex.box(), convex.radius() + max_separation + rounding);
    box_ = {box_.low + position, box_.high + position};
  }

  void run() {
    walk([&](std::uint32_t id) {
      if (out_.count < MeshCandidates::kRoom) out_.ids[out_.count] = id;
      ++out_.count;
    });
    const bool too_many = out_.count > MeshCandidates::kRoom;
    if (too_many) keep_deepest();
    // A mesh is walked in the order of its triangles.
    if (too_many || surface_.mesh == nullptr) sort();
  }

 private:
  // Calls add(id) for all triangles that may touch, without those that others stand for.
  template <class Add>
  void walk(Add&& add) {
    if (surface_.mesh != nullptr) return walk_mesh(*surface_.mesh, add);
    walk_field(*surface_.field, add);
  }

  template <class Add>
  void walk_mesh(const Mesh& mesh, Add&& add) {
    const auto enter = [&](std::uint32_t index, int lane) {
      const StaticTree::Node& node = mesh.tree.nodes[index];
      const bool flat = (mesh.flat_lanes[index] >> lane & 1) != 0;
      std::uint32_t child = node.child[lane];
      // Of a leaf each triangle is asked for itself.
      if (!flat && is_leaf(child)) return true;
      const Aabb box = child_box(node, lane);
      if (const AxisBox axes(box); !axes.overlaps(inner_) && !near_any(axes)) return false;
      if (!flat) return true;
      while (!is_leaf(child)) child = mesh.tree.nodes[child].child[0];
      const std::uint32_t first = leaf_first(child);
      return look_at_patch(mesh.normals[first], mesh.vertices[mesh.indices[3 * std::size_t(first)]], box,
                           first, add);
    };
    const AxisBox outer(box_);
    const auto overlaps = [&](const AxisBox& box) {
      return box.overlaps(outer) && (box.overlaps(inner_) || near(box));
    };
    if (kept_ != nullptr && cache_triangles(mesh, box_, kKeptMargin * convex_.size(), *kept_)) {
      const NearBoxes boxes{box_, inner_.box(), position_, max_separation_};
      static_assert(CachedTriangles::kRoom <= 32);
      std::uint32_t near =
          kernels_.find_near(columns_of(mesh), kept_->ids, kept_->count, convex_.columns(), boxes);
      for (; near != 0; near &= near - 1) add(kept_->ids[std::countr_zero(near)]);
      return;
    }
    const auto visit = [&](std::uint32_t first, std::uint32_t count) {
      for (std::uint32_t id = first; id < first + count; ++id) {
        const AxisBox box = axis_box(mesh, id);
        if (!overlaps(box)) continue;
        if ((mesh.flags[id] & kInsidePatch) != 0 &&
            !look_at_patch(mesh.normals[id], mesh.vertices[mesh.indices[3 * std::size_t(id)]], box.box(), id,
                           add)) {
          continue;
        }
        add(id);
      }
    };
    walk_overlaps(mesh.tree, box_, enter, visit);
  }

  template <class Add>
  void walk_field(const HeightField& field, Add&& add) {
    const auto enter = [&](HeightBlock block) {
      const Aabb box = block_box(field, block);
      if (!near(AxisBox(box))) return false;
      if (!is_flat(field, block)) return true;
      const std::uint32_t first = first_triangle(field, block);
      const TriangleView triangle = view_triangle(field, first);
      return look_at_patch(triangle.normal, triangle.v[0], box, first, add);
    };
    const auto visit = [&](std::uint32_t column, std::uint32_t row) {
      if (!is_solid_cell(field, column, row)) return;
      const Aabb box = block_box(field, {-1, column, row});
      if (!overlap(box, box_) || !near(AxisBox(box))) return;
      const std::uint32_t id = 2 * (row * field.cell_columns() + column);
      if (is_flat_cell(field, column, row)) {
        const TriangleView triangle = view_triangle(field, id);
        if (!look_at_patch(triangle.normal, triangle.v[0], box, id, add)) return;
      }
      add(id);
      add(id + 1);
    };
    walk_cells(field, box_, enter, visit);
  }

  // Flat corners all around: nothing of the cell but its plane can be touched.
  static bool is_flat_cell(const HeightField& field, std::uint32_t column, std::uint32_t row) {
    const auto flat = [&](std::uint32_t c, std::uint32_t r) {
      const std::size_t sample = std::size_t(r) * field.columns + c;
      return (field.flat_samples[sample / 8] >> (sample % 8) & 1) != 0;
    };
    return flat(column, row) && flat(column + 1, row) && flat(column, row + 1) && flat(column + 1, row + 1);
  }

  bool near(const AxisBox& box) const { return convex_.can_touch(box - position_, max_separation_); }
  // Whether that may be said of any box inside, however it is rounded there.
  bool near_any(const AxisBox& box) const {
    const AxisBox placed = box - position_;
    const Wide<4> farthest = max(-placed.low(), placed.high());
    const float rounding = 2.0e-6f * max(farthest[0], max(farthest[1], farthest[2]));
    return convex_.can_touch(placed, max_separation_ + rounding);
  }

  // A part that lies inside one flat patch. True if it must be entered: a corner of the shape's face may lie above it.
  template <class Add>
  bool look_at_patch(Vec3 normal, Vec3 point, const Aabb& box, std::uint32_t first, Add&& add) {
    if (surface_.double_sided() && dot(normal, convex_.center() + position_ - point) < 0.0f) normal = -normal;
    if (!side_known_ || !(side_.normal == normal)) {
      side_.normal = normal;
      const LocalConvex::Extent extent = convex_.extent(normal);
      side_.lowest = extent.low;
      side_.highest = extent.high;
      convex_.face_towards(-normal, side_.face);
      side_known_ = true;
      stand_ins_ = 0;
    }
    const float height = dot(normal, point - position_);
    if (side_.lowest - height - convex_.radius() > max_separation_) return false;
    if (side_.highest - height + convex_.radius() < 0.0f) return false;
    if (corner_above(box, height)) return true;
    if (++stand_ins_ <= kStandIns) add(first);
    if (side_.lowest - height - convex_.radius() < -0.9f * max_separation_ && near_patch(box))
      note_deep(first, normal);
    return false;
  }

  // Whether a corner of the face that faces the plane in side_ has its foot on the plane inside the box.
  bool corner_above(const Aabb& box, float height) const {
    const Aabb near_box = grow({box.low - position_, box.high - position_}, 1.0e-3f * convex_.size());
    const auto above = [&](Vec3 corner) {
      const Vec3 foot = corner - (dot(side_.normal, corner) - height) * side_.normal;
      return overlap(near_box, {foot, foot});
    };
    for (int i = 0; i < side_.face.count; ++i) {
      if (above(side_.face.vertices[i])) return true;
    }
    return convex_.has_vertices() && above(convex_.vertex(convex_.lowest_vertex(side_.normal)));
  }

  bool near_patch(const Aabb& box) const { return convex_.can_touch(AxisBox(box) - position_, 0.0f); }

  void note_deep(std::uint32_t id, Vec3 normal) {
    const float height = dot(normal, surface_.triangle(id).v[0] - position_);
    for (int i = 0; i < out_.deep_patch_count; ++i) {
      const TriangleView other = surface_.triangle(out_.deep_patches[i]);
      const float apart = absolute(dot(normal, other.v[0] - position_) - height);
      if (absolute(dot(other.normal, normal)) > 0.9999f && apart < 1.0e-3f * convex_.size()) return;
    }
    if (out_.deep_patch_count < MeshCandidates::kPatchRoom) out_.deep_patches[out_.deep_patch_count++] = id;
  }

  // How far the triangle reaches out of the shape's local box (negative: into it), and in which cell its middle lies.
  struct Place {
    float distance;
    int cell;
  };
  Place place_of(std::uint32_t id) const {
    const TriangleView t = surface_.triangle(id);
    const Vec3 a = t.v[0] - position_, b = t.v[1] - position_, c = t.v[2] - position_;
    const Vec3 middle = (a + b + c) / 3.0f;
    float distance = convex_.box_distance(middle);
    distance =
        min(distance, min(convex_.box_distance(a), min(convex_.box_distance(b), convex_.box_distance(c))));
    // Of a large triangle neither corners nor middle need be near.
    const Vec3 extent = max(a, max(b, c)) - min(a, min(b, c));
    if (largest(extent) > 0.25f * convex_.size())
      distance = convex_.lowest(t.normal) - dot(t.normal, a) - convex_.radius();
    const Aabb& local = convex_.local_box();
    const Vec3 inside = convex_.to_local(middle) - local.low, size = local.high - local.low;
    const auto cell = [](float place, float width) {
      return int(clamp(float(kCells) * place / max(width, 1.0e-30f), 0.0f, float(kCells - 1)));
    };
    return {distance,
            (cell(inside.x, size.x) * kCells + cell(inside.y, size.y)) * kCells + cell(inside.z, size.z)};
  }

  // Only of flat ground, for which the shape's face was looked at already.
  bool is_under_corner(std::uint32_t id) const {
    if (!side_known_) return false;
    const TriangleView t = surface_.triangle(id);
    return t.normal == side_.normal && corner_above(bounds(t), dot(t.normal, t.v[0] - position_));
  }

  void keep_deepest() {
    constexpr float kEmpty = __builtin_huge_valf();
    float distance[kKeptSlots];
    for (float& d : distance) d = kEmpty;
    int corners = 0;
    walk([&](std::uint32_t id) {
      if (corners < kCornerSlots && is_under_corner(id)) {
        out_.ids[kKeptSlots + corners++] = id;
        return;
      }
      const Place place = place_of(id);
      int slot = kKept * place.cell, end = slot + kKept;
      while (slot < end && distance[slot] <= place.distance) ++slot;
      if (slot == end) return;
      for (int i = end - 1; i > slot; --i) {
        distance[i] = distance[i - 1];
        out_.ids[i] = out_.ids[i - 1];
      }
      distance[slot] = place.distance;
      out_.ids[slot] = id;
    });
    out_.count = 0;
    for (int i = 0; i < kKeptSlots; ++i) {
      if (distance[i] < kEmpty) out_.ids[out_.count++] = out_.ids[i];
    }
    for (int i = 0; i < corners; ++i) out_.ids[out_.count++] = out_.ids[kKeptSlots + i];
  }

  void sort() {
    const auto less = [](std::uint32_t a, std::uint32_t b) { return a < b; };
    std::uint32_t scratch[MeshCandidates::kRoom];
    merge_sort(std::span<std::uint32_t>(out_.ids, std::size_t(out_.count)), std::span<std::uint32_t>(scratch),
               less);
  }

  const MeshKernels& kernels_;
  const Surface& surface_;
  const LocalConvex& convex_;
  Vec3 position_;
  float max_separation_;
  CachedTriangles* kept_;
  MeshCandidates& out_;
  Aabb box_;
  AxisBox inner_;
  bool side_known_ = false;
  PlaneSide side_;
  int stand_ins_ = 0;  // for the plane in side_
};

}  // namespace

void find_candidates(const MeshKernels& kernels, const Surface& surface, const LocalConvex& convex,
                     Vec3 position, float max_separation, CachedTriangles* kept, MeshCandidates& out) {
  out.count = 0;
  out.deep_patch_count = 0;
  Gatherer(kernels, surface, convex, position, max_separation, kept, out).run();
}

int find_triangles(const Surface& surface, const Aabb& box, std::span<std::uint32_t> out) {
  std::size_t count = 0;
  const auto add = [&](std::uint32_t id) {
    if (count < out.size()) out[count++] = id;
  };
  if (surface.mesh != nullptr) {
    const Mesh& mesh = *surface.mesh;
    walk_overlaps(
        mesh.tree, box, [](std::uint32_t, int) { return true; },
        [&](std::uint32_t first, std::uint32_t leaf) {
          for (std::uint32_t id = first; id < first + leaf; ++id) {
            if (overlap(triangle_box(mesh, id), box)) add(id);
          }
        });
    return int(count);
  }
  const HeightField& field = *surface.field;
  walk_cells(
      field, box, [](HeightBlock) { return true; },
      [&](std::uint32_t column, std::uint32_t row) {
        if (!is_solid_cell(field, column, row) || !overlap(block_box(field, {-1, column, row}), box)) return;
        add(2 * (row * field.cell_columns() + column));
        add(2 * (row * field.cell_columns() + column) + 1);
      });
  return int(count);
}

bool has_triangle(const Surface& surface, const Aabb& box) {
  bool found = false;
  if (surface.mesh != nullptr) {
    const Mesh& mesh = *surface.mesh;
    walk_overlaps(
        mesh.tree, box, [&](std::uint32_t, int) { return !found; },
        [&](std::uint32_t first, std::uint32_t count) {
          for (std::uint32_t id = first; id < first + count && !found; ++id)
            found = overlap(triangle_box(mesh, id), box);
        });
    return found;
  }
  const HeightField& field = *surface.field;
  walk_cells(
      field, box, [&](HeightBlock) { return !found; },
      [&](std::uint32_t column, std::uint32_t row) {
        if (is_solid_cell(field, column, row))
          found = found || overlap(block_box(field, {-1, column, row}), box);
      });
  return found;
}

}  // namespace gyre
