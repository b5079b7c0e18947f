// The narrow-phase stage: every contact that has an awake body is looked at, its manifolds are written in world axes and
// matched with those of the step before. Blocks of contacts run in parallel; each writes only its own slots.
#pragma once

#include "base/bitset.h"
#include "collision/contact_store.h"
#include "geometry/shape.h"
#include "task/task_system.h"

#include <span>

namespace gyre {

// One shape, as the stage needs it; indexed like proxies.
struct ColliderShape {
  Shape shape;
  Transform body_from_shape;
  std::uint32_t body = 0;
  float size = 0.0f;  // inner_radius of the shape, or of its thinnest part: the scale of tolerances
};

// One body, as the stage needs it.
struct ColliderBody {
  Pose pose;              // of the origin
  Vec3 center;            // centre of mass, body frame
  Vec3 linear_velocity;   // m/s, of the centre of mass
  Vec3 angular_velocity;  // rad/s
  float reach = 0.0f;     // m, farthest point of any of its shapes from the centre of mass
  bool awake = false;     // awake and not fixed
};

struct CollideInput {
  std::span<const ColliderShape> shapes;
  std::span<const ColliderBody> bodies;
  std::span<const Proxy> proxies;
  float seconds = 0.0f;  // length of the step: how far things may come
};

// Bits by contact slot, united over workers: what changed in this step.
struct TouchChanges {
  Bitset began;  // not touching before, touching now (sensors too)
  Bitset ended;  // the other way round
  Bitset gone;   // fat boxes no longer overlap: remove the contact (`ended` is set too if it was touching)
};

void collide(ContactStore& store, const CollideInput& input, TaskSystem& tasks, TouchChanges& changes);

}  // namespace gyre
