// Recycling: contacts whose two bodies have hardly moved against each other since the last full look (contact_update.h) get
// their old points again, found from their anchors. Most contacts of what rests are brought up to date so.
//
// In: contacts, their shapes and bodies; W of them are worked on side by side. Out: which of them are up to date, with
// their manifolds in world axes; and how the pairs stand and move, for the full look at the others.
//
// Let T be the rigid motion of B in A's body frame since the last full look. The point of B at an anchor moves
// by d = T(p) - p, so the separation there changes by dot(d, n) and the point midway by d / 2. With the features that meet
// unchanged this leaves out only products of the slide and the tilt. Where B is a core swept by a ball on something flat
// (a ball, a capsule), p is the core's point above the contact, the contact goes with it by the whole of d, and so follows
// what rolls exactly; where that is A, the two change places. Motion is always measured from the last FULL look, so errors
// do not add up.
#pragma once

#include "collision/contact/collide.h"
#include "collision/contact/contact_store.h"
#include "geometry/manifold/box_axes.h"

namespace gyre {

// In sizes of the pair (the smaller shape's inner radius).
// Surfaces nearer than this touch.
constexpr float kTouch = 0.005f;
// What comes faster than this in a step is left to the sweep (continuous.h).
constexpr float kMaxApproach = 1.0f;

// How far a full look reaches beyond the speculative distance: farther than needed, so that the contact may be recycled while
// the pair moves a little. Where nothing touches, and the pair goes less than kSlow in a step, it reaches far: it is cheaper
// to look once than to look in every step.
constexpr float kNearSlack = 0.03f, kFarSlack = 0.25f, kSlow = 0.02f;

// Contacts that are handed over together: one word of a bitset.
constexpr int kContactBlock = 64;

// A contact to be looked at, and its two sides.
struct ContactPair {
  Contact* contact;
  Manifold* manifolds;  // of the contact, as many as its manifold_count
  const ColliderShape* shape_a;
  const ColliderShape* shape_b;
  const CollisionBody* body_a;
  const CollisionBody* body_b;
  const BodyCenter* center_a;
  const BodyCenter* center_b;
};

// How B goes in the step, seen from A that turns along, near where the two can meet. What goes round together does not close.
struct Closing {
  Vec3 translation;  // m, in the middle of where they can meet, in the frame of View
  float lever;  // m, how far from there they can meet
  Vec3 rotation;        // rad, in the same frame
  float arc_deviation;  // m, the most that ways are longer than straight ones

  // How far surfaces can come towards each other along a unit normal from A to B.
  float along(Vec3 normal) const {
    return max(-dot(translation, normal), 0.0f) + lever * length(cross(rotation, normal)) + arc_deviation;
  }
};

// How a pair stands and moves, as far as every look needs it.
struct View {
  Transform a_from_b;  // body frames
  float size;
  float max_approach;  // m, the most that surfaces can come towards each other in the step
  float speculative;  // m, how far contacts matter
  // The frame in which manifolds are found, that of shape A; but a plane that meets a convex shape is taken to lie with its
  // frame beside that one.
  Transform shapes_a_from_b;  // of the shapes' frames
  Quat frame_orientation;     // world_from_frame
  // Its origin from either centre of mass, world axes. Each side by itself: one of the two may be far away (a plane's body),
  // and floats with it.
  Vec3 frame_from_a, frame_from_b;
  Closing closing;
  // Of two boxes, the axis that decides at this look; kNoAxis where it is still to be found, and of everything else.
  boxes::Axis axis;
};

struct Recycled {
  std::uint64_t contacts = 0;  // bits, by place: up to date
  std::uint64_t touching = 0;  // bits: those of them whose shapes touch
  std::uint64_t apart =
      0;  // bits, of the others: those that a full look would find nothing of, and it is noted
  // Of what is left. Not cleared: only theirs are ever read.
  union {
    View views[kContactBlock];
  };
  Recycled() {}
};

// A kernel takes the contacts in places [begin, end), none beyond kContactBlock, whose sizes must be known. `may_recycle` false: it tells
// only the views. What it finds is added to `recycled`. Here is the widest that this machine runs well; not wider than `width` if that is not 0.
RecycleContacts select_recycling(int width);

}  // namespace gyre
