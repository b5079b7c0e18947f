// The narrow-phase stage: updates each contact with an awake body, writes its manifolds in world axes and matches their
// points with those of the last step. Blocks of contacts run in parallel; each block writes only its own slots.
//
// Speculative distances and all other tolerances are relative to the smaller shape of a pair, so a scene ten times
// larger or smaller gives the same contacts.
#pragma once

#include "base/container/bitset.h"
#include "base/container/interned_column.h"
#include "collision/contact/contact_store.h"
#include "geometry/shape/shape.h"
#include "task/task_system.h"

#include <span>

namespace gyre {

// A shape, as the narrow phase needs it.
struct ColliderShape {
  Shape shape;
  Transform body_from_shape;
  // inner_radius of the shape, or of its thinnest piece: the scale of tolerances. With 0 (meshes, height fields) or
  // kUnbounded (planes) the other shape of a pair decides.
  float size = 0.0f;
};

// All shapes by index, as a plain array or an interned column (shape i is records[indices[i]]).
class ColliderShapes {
 public:
  template <class Shapes>
  requires std::is_convertible_v<const Shapes&, std::span<const ColliderShape>> ColliderShapes(
      const Shapes& shapes)  // NOLINT: either form is all that is needed
      : records_(std::span<const ColliderShape>(shapes).data()) {}
  ColliderShapes(const InternedColumn<ColliderShape>& shapes)  // NOLINT
      : records_(shapes.records()), indices_(shapes.indices()) {}
  const ColliderShape& operator[](std::uint32_t shape) const {
    return records_[indices_ != nullptr ? indices_[shape] : shape];
  }

 private:
  const ColliderShape* records_ = nullptr;
  const std::uint32_t* indices_ = nullptr;
};

// The source of a CollisionBody.
struct ColliderBody {
  Pose pose;                     // of the origin
  Vec3 center;                   // centre of mass, body frame
  Vec3 linear_velocity;          // m/s, of the centre of mass
  Vec3 angular_velocity;         // rad/s
  float bounding_radius = 0.0f;  // m, distance of the farthest point of its shapes from the centre of mass
  bool awake = false;            // awake and not fixed
};

// A body as contacts see it, in one cache line, made before the stage.
struct alignas(64) CollisionBody {
  DVec3 position;  // of the origin
  Quat orientation;
  Vec3 translation;  // m, of the centre of mass in the step
  Vec3 rotation;     // rad, rotation vector of the step
};

// `seconds`: length of the step.
inline CollisionBody make_collision_body(const ColliderBody& body, float seconds) {
  CollisionBody body_out;
  body_out.position = body.pose.position;
  body_out.orientation = body.pose.orientation;
  body_out.translation = seconds * body.linear_velocity;
  if (body.awake) body_out.rotation = seconds * body.angular_velocity;
  return body_out;
}

// A kernel of contact_recycle.h.
struct PairInput;
struct Recycled;
using RecycleContacts = void (*)(const PairInput* pairs, int begin, int end, bool allow_recycling,
                                 Recycled& recycled);

// The centre of mass in the body frame and the bounding radius, loaded as four floats.
struct alignas(16) BodyCenter {
  Vec3 position;
  float bounding_radius = 0.0f;  // m
};
// m, an upper bound of the distance of the farthest point from the body's origin.
inline float extent_of(const BodyCenter& center) { return center.bounding_radius + length(center.position); }

struct CollideInput {
  ColliderShapes shapes;
  std::span<const CollisionBody> bodies;  // by body
  std::span<const BodyCenter> centers;    // by body
  std::span<const std::uint8_t> awake;    // by body: 1 for awake bodies that are not fixed
  std::span<const Proxy> proxies;
  // Contacts to update, by slot. In all other contacts both bodies sleep and the boxes did not change.
  const Bitset& active;
  RecycleContacts recycle_contacts;
  bool recycle = true;  // false: updates every pair in full, for comparison in tests
};

// Changes of this step, as bits by contact slot.
struct TouchChanges {
  Bitset began;         // not touching before, touching now (sensors too)
  Bitset ended;         // touching before, not touching now
  Bitset gone;          // fat boxes no longer overlap: to be removed; `ended` is set too if it touched
  Bitset on_static;     // updated, has points, and contacts move only one of the two (for internal_edges.h)
  Bitset ccd_blockers;  // active, not gone, and blocks_fast_bodies() (for continuous.h)
};

// True if one of the two shapes is not pushed, or is a sensor.
inline bool blocks_fast_bodies(const Contact& contact, std::span<const Proxy> proxies) {
  return !proxies[contact.shape_a].pushes || !proxies[contact.shape_b].pushes || contact.sensor != 0;
}

// Updates the active contacts. A contact without an awake body stays exactly as it is, unless it is gone or an unseen sensor's. In updated
// manifolds the sums over a step (total_impulse, total_friction) and approach_speed become zero; warm-start impulses
// are carried over.
void collide(ContactStore& store, const CollideInput& input, TaskSystem& tasks, TouchChanges& changes);

}  // namespace gyre
