// Recycling: contacts whose two bodies have hardly moved against each other since the last full look (contact_update.h) get
// their old points again, found from their anchors. Most contacts of a pile at rest are brought up to date so.
//
// In: contacts, side by side in the lanes of one register, their shapes and bodies. Out: which of them are up to date, with
// their manifolds in world axes; and how the pairs stand and move, for the full look at the others.
//
// Let T be the rigid motion of B in A's body frame since the last full look. The point of B at an anchor moves
// by d = T(p) - p, so the separation there changes by dot(d, n) and the point midway by d / 2. With the features that meet
// unchanged this leaves out only products of the slide and the tilt. Where B is a core swept by a ball on something flat
// (a ball, a capsule), p is the core's point above the contact, the contact goes with it by the whole of d, and so follows
// what rolls exactly; where that is A, the two change places. Motion is always measured from the last FULL look, so errors
// do not add up.
#pragma once

#include "collision/collide.h"
#include "collision/contact_store.h"

namespace gyre {

// Surfaces nearer than this touch. In sizes of the pair (the smaller shape's inner radius), as all lengths here.
constexpr float kTouch = 0.005f;
// What comes faster than this in a step is left to the sweep (continuous.h).
constexpr float kLargestApproach = 1.0f;

// How many contacts are looked at side by side: as many as every processor has lanes.
constexpr int kLookWidth = 4;

// How a pair stands and moves, as far as every look needs it.
struct View {
  Transform a_from_b;  // body frames
  float size;
  float way;          // m, the most that surfaces can come towards each other in the step
  float speculative;  // m, how far contacts matter
};

// How a manifold follows the bodies. Its anchors lie in the frame of one of them, and the other one's points move there.
// Where that one is a core swept by a ball on something flat, the points of its core are what counts: however it rolls,
// it touches below them.
struct Follow {
  bool frame_is_b = false;  // else A's
  bool flat = false;        // flat features on both sides
  bool round = false;       // a swept core on something flat
  float radius = 0.0f;      // of the swept core
};
Follow follow_of(const Shape& a, const Shape& b);

// The smaller of two sizes, of those that are sizes at all (see ColliderShape::size).
float smaller_size(float a, float b);

struct Recycled {
  unsigned contacts = 0;   // bits, by place in the group: up to date
  unsigned touching = 0;   // bits: those of them whose shapes touch
  View views[kLookWidth];  // of all; not set if all are up to date
};
// Of at most kLookWidth contacts. `may_recycle` false: only the views.
Recycled recycle_contacts(ContactStore& store, std::span<const std::uint32_t> slots,
                          const CollideInput& input);

}  // namespace gyre
