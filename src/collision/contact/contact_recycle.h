// Contact recycling: contacts whose bodies hardly moved against each other since the last full update
// (contact_update.h) get their old points back, moved by the anchors. Most contacts at rest are updated this way.
//
// In: contacts, their shapes and bodies, W side by side. Out: which contacts are up to date, with manifolds in world
// axes; and views of the others, for the full update.
//
// Let T be the rigid motion of B in A's body frame since the last full update. The point of B at an anchor p moves by d
// = T(p) - p, so the separation there changes by dot(d, n) and the midpoint by d / 2. While the same features meet, the
// error is of second order: products of slide and tilt. If B is a core rounded by a ball (a ball, a capsule) on
// something flat, p is the core's point above the contact, and the contact moves with it by the whole of d; so it
// follows rolling exactly. If A is the rounded shape, the two change roles. Motion is always measured from the last
// full update, so errors do not accumulate.
#pragma once

#include "collision/contact/collide.h"
#include "collision/contact/contact_store.h"
#include "geometry/manifold/box_axes.h"

namespace gyre {

// In sizes of the pair (inner radius of the smaller shape). Surfaces nearer than this touch.
constexpr float kTouch = 0.005f;
// Faster approaches, in sizes a step, are left to CCD (continuous.h). Two convex shapes that bounce are seen further ahead, since they go on from
// where they meet within the step (solver/contact/impact.h): a ball of 1 cm that falls 1 m approaches by 15.
constexpr float kMaxApproach = 1.0f, kMaxBounceApproach = 16.0f;

// How far a full update searches beyond the speculative distance, so that the contact may be recycled while the pair
// moves a little. A pair without contact that moves less than kSlow in a step is searched with kFarSlack: one far
// search costs less than a search in every step.
constexpr float kNearSlack = 0.03f, kFarSlack = 0.25f, kSlow = 0.02f;

// Contacts that a kernel gets at once: one word of a bitset.
constexpr int kContactBlock = 64;

// A contact to update and its two sides.
struct PairInput {
  Contact* contact;
  Manifold* manifolds;  // of the contact: manifold_count of them
  const ColliderShape* shape_a;
  const ColliderShape* shape_b;
  const CollisionBody* body_a;
  const CollisionBody* body_b;
  const BodyCenter* center_a;
  const BodyCenter* center_b;
};

// The motion of B in the step relative to A, in A's rotating frame, near where the two can meet. Two bodies in rigid
// co-rotation have zero closing speed.
struct Closing {
  Vec3 translation;     // m, in the middle of the region where they can meet, in the frame of PairView
  float lever;          // m, radius of that region
  Vec3 rotation;        // rad, relative rotation vector, in the same frame
  float arc_deviation;  // m, an upper bound of the deviation of arcs from straight lines

  // An upper bound of the approach of the surfaces along a unit normal from A to B.
  float along(Vec3 normal) const {
    return max(-dot(translation, normal), 0.0f) + lever * length(cross(rotation, normal)) + arc_deviation;
  }
};

// The relative pose and motion of a pair, as an update needs them.
struct PairView {
  Transform a_from_b;  // body frames
  float size;
  float max_approach;  // m, an upper bound of the approach of the surfaces in the step
  float speculative;   // m, speculative distance
  // Manifolds are found in the frame of shape A. A plane that meets a convex shape has its frame moved beside that
  // shape.
  Transform shapes_a_from_b;  // of the shapes' frames
  Quat frame_orientation;     // world_from_frame
  // m, from each centre of mass to the frame's origin, world axes. Two vectors, because one body may be far away (that
  // of a plane), and floats lose digits there.
  Vec3 frame_from_a, frame_from_b;
  Closing closing;
  // For two boxes, the axis that decides this update; kNoAxis if it is unknown, and for all other shapes.
  boxes::Axis axis;
};

struct Recycled {
  std::uint64_t contacts = 0;  // bits, by index: up to date
  std::uint64_t touching = 0;  // bits: those of them that touch
  std::uint64_t apart = 0;  // bits, of the others: a full update would find nothing, and the contact says so
  // Of the remaining contacts. Not cleared: only their views are read.
  union {
    PairView views[kContactBlock];
  };
  Recycled() {}
};

// A kernel updates the contacts [begin, end), at most kContactBlock, whose sizes must be known, and adds its results to
// `recycled`. With `allow_recycling` false it only writes views. Returns the widest kernel that this machine runs well,
// at most `width` wide if that is not 0.
RecycleContacts select_recycling(int width);

}  // namespace gyre
