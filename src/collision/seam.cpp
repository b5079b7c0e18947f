// Which contacts are hidden by a flush neighbour. See seam.h.
#include "collision/seam.h"

#include "geometry/gjk.h"
#include "geometry/support.h"
#include "task/parallel.h"

namespace gyre {
namespace {

constexpr int kBlock = 64;  // contacts: one word of the bits
// Normals nearer than this are of one face.
constexpr float kSameFace = 0.99999f;

// A contact of a shape that is pushed with one that is not, from the latter's side.
struct Side {
  std::uint32_t mover, other;            // shapes
  std::uint32_t mover_body, other_body;  // their bodies
  float out = 1.0f;                      // times the manifold's normal: out of the other, towards the mover
};

// False if the contact is of another sort.
bool find_side(const ContactStore& store, std::uint32_t slot, const CollideInput& input, Side& side) {
  const Contact& c = store.contacts[slot];
  if (c.manifold_room != 1 || c.manifold_count == 0 || c.sensor != 0) return false;
  const bool a_moves = input.proxies[c.shape_a].pushes, b_moves = input.proxies[c.shape_b].pushes;
  if (a_moves == b_moves) return false;
  side = a_moves ? Side{c.shape_a, c.shape_b, c.body_a, c.body_b, -1.0f}
                 : Side{c.shape_b, c.shape_a, c.body_b, c.body_a, 1.0f};
  return true;
}

// Both stand still, or go along together without turning.
bool rest_together(const CollideInput& input, std::uint32_t a, std::uint32_t b) {
  if (a == b) return true;
  const BodyLook& look_a = input.looks[a];
  const BodyLook& look_b = input.looks[b];
  return look_a.way == look_b.way && look_a.spin <= 0.0f && look_b.spin <= 0.0f;
}

// How far the shape reaches beyond a point along a unit direction, in the frame of the shape.
float reach_beyond(const Shape& shape, Vec3 point, Vec3 direction) {
  if (shape.kind == ShapeKind::plane) {
    if (dot(shape.extents, direction) < kSameFace) return kUnbounded;
    return shape.offset - dot(shape.extents, point);
  }
  return dot(support(shape, direction) - point, direction) + core_radius(shape);
}

bool holds(const Shape& shape, Vec3 point, float slack) {
  if (shape.kind == ShapeKind::plane) return dot(shape.extents, point) - shape.offset <= slack;
  Shape dot_shape;
  dot_shape.radius = 0.0f;
  const double near = double(core_radius(shape)) + double(slack);
  const CoreDistance found = core_distance(CorePair(shape, dot_shape, {point, {}}), near, {});
  return found.overlap || (!found.beyond && found.distance <= near);
}

// A resting shape where it lies, to be asked about points in world axes measured from a body's centre of mass.
class PlacedShape {
 public:
  PlacedShape(const CollideInput& input, std::uint32_t shape, std::uint32_t body, std::uint32_t from_body)
      : shape_(input.shapes[shape]), look_(input.looks[body]) {
    const BodyLook& from = input.looks[from_body];
    origin_ = difference(from.position, look_.position) + rotate(from.orientation, input.centers[from_body]);
  }
  const Shape& shape() const { return shape_.shape; }
  Vec3 point(Vec3 p) const {
    return inverse_times(shape_.body_from_shape, rotate_inverse(look_.orientation, origin_ + p));
  }
  Vec3 direction(Vec3 d) const {
    return rotate_inverse(shape_.body_from_shape.orientation, rotate_inverse(look_.orientation, d));
  }

 private:
  const ColliderShape& shape_;
  const BodyLook& look_;
  Vec3 origin_;
};

// Whether all points of a contact are hidden by the neighbour with which the mover has a contact too: they lie in it, it
// goes on beyond them, and the contact's own shape does not rise out of it.
bool hides(const ContactStore& store, const CollideInput& input, const Contact& contact, const Side& side,
           const Contact& other, const Side& neighbour) {
  const Manifold& manifold = store.manifolds[contact.first_manifold];
  const Vec3 out = side.out * manifold.normal;
  const Vec3 up = neighbour.out * store.manifolds[other.first_manifold].normal;
  const PlacedShape own(input, side.other, side.other_body, contact.body_a);
  const PlacedShape by(input, neighbour.other, neighbour.other_body, contact.body_a);
  const float slack = kFlush * contact.size;
  for (int i = 0; i < manifold.count; ++i) {
    const ContactPointState& state = manifold.points[i];
    // The point midway, and from there half the separation back to the surface.
    const Vec3 point = state.from_a - 0.5f * state.separation * out;
    if (reach_beyond(own.shape(), own.point(point), own.direction(up)) > 2.0f * slack) return false;
    if (reach_beyond(by.shape(), by.point(point), by.direction(out)) <= 2.0f * slack) return false;
    if (!holds(by.shape(), by.point(point), slack)) return false;
  }
  return true;
}

bool is_hidden(const ContactStore& store, std::uint32_t slot, const CollideInput& input) {
  Side side;
  if (!find_side(store, slot, input, side) || input.looks[side.mover_body].spin < 0.0f) return false;
  const Contact& contact = store.contacts[slot];
  const Manifold& manifold = store.manifolds[contact.first_manifold];
  bool hidden = false;
  for_each_contact_of_shape(store, side.mover, [&](std::uint32_t other_slot) {
    Side neighbour;
    if (hidden || other_slot == slot || !find_side(store, other_slot, input, neighbour)) return;
    if (neighbour.mover != side.mover || !rest_together(input, side.other_body, neighbour.other_body)) return;
    const Contact& other = store.contacts[other_slot];
    const Manifold& its = store.manifolds[other.first_manifold];
    if (side.out * neighbour.out * dot(manifold.normal, its.normal) > kSameFace) return;
    // Two that hide each other both stay: better a bump than a hole.
    hidden = hides(store, input, contact, side, other, neighbour) &&
             !hides(store, input, other, neighbour, contact, side);
  });
  return hidden;
}

}  // namespace

void hide_seams(ContactStore& store, const CollideInput& input, TaskSystem& tasks, Bitset& hidden) {
  const std::size_t count = store.contacts.size();
  if (hidden.size() < count) hidden.resize(count);
  hidden.reset_all();
  // All are asked before any is changed: nobody is hidden by who is hidden earlier in the list.
  for_blocks(tasks, int(count), kBlock, [&](int begin, int end, int) {
    for (int slot = begin; slot < end; ++slot) {
      if (is_hidden(store, std::uint32_t(slot), input)) hidden.set(std::size_t(slot));
    }
  });
  hidden.for_each_set([&](std::size_t slot) {
    Contact& contact = store.contacts[slot];
    store.manifolds[contact.first_manifold] = {};
    contact.manifold_count = 0;
    forget_look(contact);
  });
}

}  // namespace gyre
