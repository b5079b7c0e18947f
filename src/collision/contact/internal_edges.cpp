// Finds contacts that a flush neighbour hides. See internal_edges.h.
#include "collision/contact/internal_edges.h"

#include "base/container/sort.h"
#include "geometry/distance/gjk.h"
#include "geometry/manifold_mesh/mesh_candidates.h"
#include "geometry/shape/support.h"
#include "task/parallel.h"

#include <algorithm>

namespace gyre {
namespace {

constexpr int kContactsPerBlock = 64;  // contacts: one word of bits
// Normals with a larger cosine belong to one face.
constexpr float kSameFace = 0.99999f;
// Sine of the smallest angle between a normal and the triangle's.
constexpr float kLeaning = 1.0e-3f;

// A contact of a pushed shape with one that is not pushed, seen from the latter.
struct Side {
  std::uint32_t mover, other;            // shapes
  std::uint32_t mover_body, other_body;  // their bodies
  float out = 1.0f;                      // factor on the manifold's normal, so that it points to the mover
};

// False for any other contact.
bool find_side(const ContactStore& store, std::uint32_t slot, const CollideInput& input, Side& side) {
  const Contact& c = store.contacts[slot];
  if (c.manifold_room == 0 || c.manifold_count == 0 || c.sensor != 0) return false;
  const bool a_moves = input.proxies[c.shape_a].pushes, b_moves = input.proxies[c.shape_b].pushes;
  if (a_moves == b_moves) return false;
  side = a_moves ? Side{c.shape_a, c.shape_b, c.body_a, c.body_b, -1.0f}
                 : Side{c.shape_b, c.shape_a, c.body_b, c.body_a, 1.0f};
  return true;
}

// True if the two bodies are at rest or translate together without rotation.
bool move_together(const CollideInput& input, std::uint32_t a, std::uint32_t b) {
  if (a == b) return true;
  const CollisionBody& body_a = input.bodies[a];
  const CollisionBody& body_b = input.bodies[b];
  return body_a.translation == body_b.translation && body_a.rotation == Vec3{} && body_b.rotation == Vec3{};
}

// How far the shape extends beyond a point along a unit direction, in the frame of the shape.
float extent_beyond(const Shape& shape, Vec3 point, Vec3 direction) {
  if (shape.kind == ShapeKind::plane) {
    if (dot(shape.extents, direction) < kSameFace) return kUnbounded;
    return shape.offset - dot(shape.extents, point);
  }
  return dot(support(shape, direction) - point, direction) + core_radius(shape);
}

bool contains_point(const Shape& shape, Vec3 point, float slack) {
  if (shape.kind == ShapeKind::plane) return dot(shape.extents, point) - shape.offset <= slack;
  Shape dot_shape;
  dot_shape.radius = 0.0f;
  const double near = double(core_radius(shape)) + double(slack);
  const CoreDistance found = core_distance(CorePair(shape, dot_shape, {point, {}}), near, {});
  return found.overlap || (!found.beyond && found.distance <= near);
}

// A static shape (here any shape that contacts do not push) in the world, for queries about points in world axes
// measured from a body's centre of mass.
class StaticShape {
 public:
  StaticShape(const CollideInput& input, std::uint32_t shape, std::uint32_t body, std::uint32_t from_body)
      : shape_(input.shapes[shape]), body_(input.bodies[body]) {
    const CollisionBody& from = input.bodies[from_body];
    origin_ = difference(from.position, body_.position) +
              rotate(from.orientation, input.centers[from_body].position);
  }
  const Shape& shape() const { return shape_.shape; }
  Vec3 point(Vec3 p) const {
    return inverse_times(shape_.body_from_shape, rotate_inverse(body_.orientation, origin_ + p));
  }
  Vec3 direction(Vec3 d) const {
    return rotate_inverse(shape_.body_from_shape.orientation, rotate_inverse(body_.orientation, d));
  }

 private:
  const ColliderShape& shape_;
  const CollisionBody& body_;
  Vec3 origin_;
};

bool is_surface(const Shape& shape) {
  return shape.kind == ShapeKind::mesh || shape.kind == ShapeKind::height_field;
}

// How far a shape extends beyond a point along a direction; of a surface only the touched triangle counts.
float height_above(const Shape& shape, std::uint32_t triangle, Vec3 point, Vec3 direction) {
  if (!is_surface(shape)) return extent_beyond(shape, point, direction);
  const TriangleView view = Surface(shape).triangle(triangle);
  float highest = -kUnbounded;
  for (const Vec3 corner : view.v) highest = max(highest, dot(corner - point, direction));
  return highest;
}

// True if the surface continues, level, from a point in the direction of the lean: a small step ahead, a triangle of
// the point's plane still lies there.
bool continues_level(const Shape& shape, Vec3 point, Vec3 direction, float slack) {
  const Surface surface(shape);
  std::uint32_t ids[32];
  const int count = find_triangles(surface, grow({point, point}, 3.0f * slack), ids);
  for (int i = 0; i < count; ++i) {
    const TriangleView view = surface.triangle(ids[i]);
    if (absolute(dot(view.normal, point - view.v[0])) > slack) continue;
    const Vec3 leaning = direction - dot(direction, view.normal) * view.normal;
    // The triangle's own normal makes no internal edge.
    if (length_squared(leaning) < kLeaning * kLeaning) continue;
    const Vec3 ahead = point + 2.0f * slack * normalized(leaning);
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = view.v[next_corner(k)] - view.v[k];
      inside = inside && dot(cross(edge, view.normal), ahead - view.v[k]) <= 0.0f;
    }
    if (inside) return true;
  }
  return false;
}

// True if the neighbour contains a point of the contact and continues beyond it along the contact's normal.
bool continues_beyond(const Shape& shape, Vec3 point, Vec3 direction, float slack) {
  if (is_surface(shape)) return continues_level(shape, point, direction, slack);
  return extent_beyond(shape, point, direction) > 2.0f * slack && contains_point(shape, point, slack);
}

// A manifold between a mover and a static shape.
struct Patch {
  const Contact& contact;
  const Side& side;
  const Manifold& manifold;
  Vec3 out() const { return side.out * manifold.normal; }
};

// Two manifolds of one mover: which points of the first may be hidden beside the second.
class Beside {
 public:
  Beside(const CollideInput& input, const Patch& own, const Patch& neighbour)
      : input_(input),
        own_(own),
        neighbour_(neighbour),
        own_shape_(input, own.side.other, own.side.other_body, own.contact.body_a),
        out_(own.out()),
        up_(own_shape_.direction(neighbour.out())),
        slack_(kFlushShare * own.contact.size) {}

  // True if the manifold's own shape does not rise above the neighbour's surface at a point.
  bool is_level(int i) const {
    return height_above(own_shape_.shape(), own_.manifold.triangle, own_shape_.point(surface_point(i)),
                        up_) <= 2.0f * slack_;
  }
  // True if a static shape contains a point and continues beyond it.
  bool is_inside(int i, std::uint32_t shape, std::uint32_t body) const {
    const StaticShape by(input_, shape, body, own_.contact.body_a);
    return continues_beyond(by.shape(), by.point(surface_point(i)), by.direction(out_), slack_);
  }
  bool hides(int i) const {
    return is_level(i) && is_inside(i, neighbour_.side.other, neighbour_.side.other_body);
  }
  bool hides_all() const {
    for (int i = 0; i < own_.manifold.count; ++i) {
      if (!hides(i)) return false;
    }
    return true;
  }

 private:
  // The point is midway between the surfaces; half the separation back lies the static surface.
  Vec3 surface_point(int i) const {
    const ContactPointState& state = own_.manifold.points[i];
    return state.from_a - 0.5f * state.separation * out_;
  }

  const CollideInput& input_;
  const Patch& own_;
  const Patch& neighbour_;
  const StaticShape own_shape_;
  const Vec3 out_, up_;
  const float slack_;
};

// The contacts with static shapes of each mover that has several. A mover on one shape alone has no internal edge below
// it; for such movers, the most common ones, only the number is stored.
class StaticContacts {
 public:
  StaticContacts(const ContactStore& store, const CollideInput& input, const Bitset& on_static, Arena& arena)
      : counts_(arena.make<std::uint8_t>(input.proxies.size())) {
    for (std::uint8_t& count : counts_) count = 0;
    const auto for_each = [&](auto&& fn) {
      on_static.for_each_set([&](std::size_t slot) {
        Side side;
        if (find_side(store, std::uint32_t(slot), input, side)) fn(std::uint32_t(slot), side.mover);
      });
    };
    std::size_t listed = 0;
    for_each([&](std::uint32_t, std::uint32_t mover) {
      // The second contact makes the first one count too.
      if (counts_[mover] > 0) listed += counts_[mover] == 1 ? 2 : 1;
      if (counts_[mover] < 2) ++counts_[mover];
    });
    const std::span<std::uint64_t> keys = arena.make<std::uint64_t>(listed);
    std::size_t next = 0;
    for_each([&](std::uint32_t slot, std::uint32_t mover) {
      if (has_several(mover)) keys[next++] = std::uint64_t(mover) << 32 | slot;
    });
    radix_sort_u64(keys, arena.make<std::uint64_t>(listed));
    keys_ = keys;
  }

  bool has_several(std::uint32_t mover) const { return counts_[mover] > 1; }
  // For a mover with several; the lower half of each key is the slot.
  std::span<const std::uint64_t> of(std::uint32_t mover) const {
    const auto begin = std::lower_bound(keys_.begin(), keys_.end(), std::uint64_t(mover) << 32);
    auto end = begin;
    while (end != keys_.end() && *end >> 32 == mover) ++end;
    return {begin, end};
  }

 private:
  std::span<std::uint8_t> counts_;       // by shape; 2 stands for two or more
  std::span<const std::uint64_t> keys_;  // mover and slot, ascending
};

// The context of all queries.
struct Scene {
  const ContactStore& store;
  const CollideInput& input;
  const StaticContacts& static_contacts;
};

// A contact that may be hidden, and the contacts of the same mover.
struct Candidate {
  std::uint32_t slot;
  Side side;
  std::span<const std::uint64_t> neighbours;
};

// True if another static shape beside the mover contains a point of the patch and continues beyond it, touched or not.
bool is_inside_another(const Scene& scene, const Candidate& candidate, const Patch& own, const Beside& beside,
                       int point) {
  bool inside = false;
  for_each_contact_of_shape(scene.store, own.side.mover, [&](std::uint32_t slot) {
    const Contact& pair = scene.store.contacts[slot];
    if (inside || slot == candidate.slot || pair.sensor != 0) return;
    const bool is_a = pair.shape_a == own.side.mover;
    const std::uint32_t shape = is_a ? pair.shape_b : pair.shape_a, body = is_a ? pair.body_b : pair.body_a;
    if (scene.input.proxies[shape].pushes || !move_together(scene.input, own.side.other_body, body)) return;
    inside = beside.is_inside(point, shape, body);
  });
  return inside;
}

// True if a point of the patch is hidden beside one of the mover's other manifolds.
bool is_point_hidden(const Scene& scene, const Candidate& candidate, const Patch& own, int point) {
  for (const std::uint64_t key : candidate.neighbours) {
    const auto slot = std::uint32_t(key);
    Side side;
    if (slot == candidate.slot || !find_side(scene.store, slot, scene.input, side)) continue;
    if (!move_together(scene.input, own.side.other_body, side.other_body)) continue;
    const Contact& other = scene.store.contacts[slot];
    for (std::uint32_t m = 0; m < other.manifold_count; ++m) {
      const Patch by{other, side, scene.store.manifolds[other.first_manifold + m]};
      if (dot(own.out(), by.out()) > kSameFace) continue;
      const Beside beside(scene.input, own, by);
      // If two manifolds hide each other, both stay: a bump is better than a hole.
      if (!beside.is_level(point) || Beside(scene.input, by, own).hides_all()) continue;
      if (is_inside_another(scene, candidate, own, beside, point)) return true;
    }
  }
  return false;
}

// True if all points are hidden; mostly the first is not, which ends the search.
bool is_hidden(const Scene& scene, const Candidate& candidate, int index) {
  const Contact& contact = scene.store.contacts[candidate.slot];
  const Patch own{contact, candidate.side,
                  scene.store.manifolds[contact.first_manifold + std::uint32_t(index)]};
  for (int i = 0; i < own.manifold.count; ++i) {
    if (!is_point_hidden(scene, candidate, own, i)) return false;
  }
  return true;
}

// Bits of the hidden manifolds of a contact.
std::uint8_t hidden_manifolds(const Scene& scene, std::uint32_t slot) {
  Side side;
  if (!find_side(scene.store, slot, scene.input, side)) return 0;
  if (!scene.static_contacts.has_several(side.mover) || scene.input.awake[side.mover_body] == 0) return 0;
  const Candidate candidate{slot, side, scene.static_contacts.of(side.mover)};
  unsigned mask = 0;
  for (int i = 0; i < scene.store.contacts[slot].manifold_count; ++i) {
    if (is_hidden(scene, candidate, i)) mask |= 1u << i;
  }
  return std::uint8_t(mask);
}

// Removes hidden manifolds from a contact.
void remove_manifolds(ContactStore& store, std::uint32_t slot, std::uint8_t mask) {
  Contact& contact = store.contacts[slot];
  Manifold* const manifolds = &store.manifolds[contact.first_manifold];
  int count = 0;
  for (int i = 0; i < contact.manifold_count; ++i) {
    if ((mask >> i & 1) != 0) continue;
    if (count != i) manifolds[count] = manifolds[i];
    ++count;
  }
  for (int i = count; i < contact.manifold_count; ++i) manifolds[i] = {};
  contact.manifold_count = std::uint16_t(count);
  invalidate_cache(contact);
}
static_assert(kMaxMeshManifolds <= 8);

}  // namespace

void remove_internal_edge_contacts(ContactStore& store, const CollideInput& input, const Bitset& on_static,
                                   Arena& arena, TaskSystem& tasks, InternalEdgeScratch& scratch) {
  const ArenaScope scope(arena);
  const std::size_t count = store.contacts.size();
  if (scratch.hidden.size() < count) scratch.hidden.resize(count);
  scratch.hidden.reset_all();
  const StaticContacts static_contacts(store, input, on_static, arena);
  const Scene scene{store, input, static_contacts};
  // All contacts are tested before any changes, so a hidden contact still hides others.
  for_blocks(tasks, int(count), kContactsPerBlock, [&](int begin, int, int) {
    for (std::uint64_t left = on_static.words()[std::size_t(begin / kContactsPerBlock)]; left != 0;
         left &= left - 1) {
      const auto slot = std::uint32_t(begin + std::countr_zero(left));
      if (hidden_manifolds(scene, slot) != 0) scratch.hidden.set(slot);
    }
  });
  // The few contacts found are tested again for their manifolds.
  scratch.found.clear();
  scratch.hidden.for_each_set([&](std::size_t slot) {
    scratch.found.push_back({std::uint32_t(slot), hidden_manifolds(scene, std::uint32_t(slot))});
  });
  for (const InternalEdgeScratch::Found& found : scratch.found)
    remove_manifolds(store, found.slot, found.manifolds);
}

}  // namespace gyre
