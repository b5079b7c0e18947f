// The narrow-phase stage: every contact that has an awake body is looked at, its manifolds are written in world axes and
// matched with those of the step before. Blocks of contacts run in parallel; each writes only its own slots.
//
// Distances at which contacts are looked for, and all other tolerances, are relative to the smaller shape of a pair: the
// same scene ten times larger or smaller gives the same contacts.
#pragma once

#include "base/container/bitset.h"
#include "base/container/interned_column.h"
#include "collision/contact/contact_store.h"
#include "geometry/shape/shape.h"
#include "task/task_system.h"

#include <span>

namespace gyre {

// One shape, as the stage needs it.
struct ColliderShape {
  Shape shape;
  Transform body_from_shape;
  // inner_radius of the shape, or of its thinnest part: the scale of tolerances. 0 (meshes, height fields) and kUnbounded
  // (planes) leave that to the shape they meet.
  float size = 0.0f;
};

// All shapes, by index: plainly, or shared (shape i is records[places[i]]).
class ColliderShapes {
 public:
  template <class Shapes>
  requires std::is_convertible_v<const Shapes&, std::span<const ColliderShape>> ColliderShapes(
      const Shapes& shapes)  // NOLINT: either form is all that is needed
      : records_(std::span<const ColliderShape>(shapes).data()) {}
  ColliderShapes(const InternedColumn<ColliderShape>& shapes)  // NOLINT
      : records_(shapes.records()), places_(shapes.body_from_shape()) {}
  const ColliderShape& operator[](std::uint32_t shape) const {
    return records_[places_ != nullptr ? places_[shape] : shape];
  }

 private:
  const ColliderShape* records_ = nullptr;
  const std::uint32_t* places_ = nullptr;
};

// One body, as its look is made from it.
struct ColliderBody {
  Pose pose;              // of the origin
  Vec3 center;            // centre of mass, body frame
  Vec3 linear_velocity;   // m/s, of the centre of mass
  Vec3 angular_velocity;  // rad/s
  float reach = 0.0f;     // m, farthest point of any of its shapes from the centre of mass
  bool awake = false;     // awake and not fixed
};

// What contacts need to know of a body, in one cache line. Made before the stage.
struct alignas(64) CollisionBody {
  DVec3 position;  // of the origin
  Quat orientation;
  Vec3 way;   // m, how far the centre of mass goes in the step
  Vec3 turn;  // rad, how far the body turns in the step
};

// `seconds`: length of the step, how far things may come.
inline CollisionBody make_collision_body(const ColliderBody& body, float seconds) {
  CollisionBody look;
  look.position = body.pose.position;
  look.orientation = body.pose.orientation;
  look.way = seconds * body.linear_velocity;
  if (body.awake) look.turn = seconds * body.angular_velocity;
  return look;
}

// How contacts are recycled: a kernel of contact_recycle.h.
struct ContactPair;
struct Recycled;
using RecycleContacts = void (*)(const ContactPair* pairs, int begin, int end, bool may_recycle,
                                 Recycled& recycled);

// A body's centre of mass in its frame, and how far its farthest point is from there. Four floats are read at a time.
struct alignas(16) BodyCenter {
  Vec3 position;
  float reach = 0.0f;  // m
};
// A bound of the farthest point from the body's origin, m.
inline float extent_of(const BodyCenter& center) { return center.reach + length(center.position); }

struct CollideInput {
  ColliderShapes shapes;
  std::span<const CollisionBody> looks;  // by body
  std::span<const BodyCenter> centers;  // by body
  std::span<const std::uint8_t> awake;  // by body: 1 for those that are, and not fixed
  std::span<const Proxy> proxies;
  // Contacts, by slot: of the others both bodies sleep and the boxes are as they were, so nothing is to be done. Only bodies of these
  // need a look.
  const Bitset& asked;
  RecycleContacts recycle_contacts;
  bool recycle = true;  // false: looks at every pair anew (tests compare with that)
};

// Bits by contact slot: what changed in this step.
struct TouchChanges {
  Bitset began;  // not touching before, touching now (sensors too)
  Bitset ended;  // the other way round
  Bitset gone;   // fat boxes no longer overlap: remove the contact (`ended` is set too if it was touching)
  Bitset beside_resting;  // looked at, has points, and only one of the two is moved by contacts (for seam.h)
  Bitset
      may_stop;  // asked, not gone, and blocks_fast_bodies(): what is fast may have to stop (for continuous.h)
};

// Whether one of the two is not pushed, or is a sensor.
inline bool blocks_fast_bodies(const Contact& contact, std::span<const Proxy> proxies) {
  return !proxies[contact.shape_a].pushes || !proxies[contact.shape_b].pushes || contact.sensor != 0;
}

// Brings the contacts that are asked up to date. One with no awake body is left exactly as it is, unless it is gone.
// In manifolds of contacts that were looked at, what solvers report over a step (total_impulse, total_friction,
// approach_speed) is zero again; impulses to start from are carried over.
void collide(ContactStore& store, const CollideInput& input, TaskSystem& tasks, TouchChanges& changes);

}  // namespace gyre
