// Islands: bodies that hang together by contacts and joints rest and wake together.
//
// Waking: a body that is awake and touches a sleeping one wakes its whole group. Sleeping: when every body of an island has
// hardly moved for a while and something holds it up, the island sleeps as one group (a ring through BodySleep). Islands
// are found anew, by union-find over contacts and joints of awake bodies, only in steps in which somebody could rest.
#pragma once

#include "base/arena.h"
#include "rigid/rigid_world.h"

namespace gyre {

// A body rests after so long without motion.
constexpr float kTimeToSleep = 0.5f;  // s
// Motion that counts as none: this share of sqrt(gravity * reach), the body's natural speed.
constexpr float kRestShare = 0.015f;

// Wakes a body's group; nothing if it is awake. Events are added to w.events.
void wake(RigidWorld& w, std::uint32_t body);
void wake_all(RigidWorld& w);
// Wakes everything that touches the body or is joined to it (before it is removed or moved away).
void wake_neighbours(RigidWorld& w, std::uint32_t body);
// Stage: wakes sleeping bodies that awake or moving ones have come to touch or are joined to.
void wake_touched(RigidWorld& w);
// Stage: updates the rest timers of awake bodies and puts resting islands to sleep.
void put_to_sleep(RigidWorld& w, Arena& arena, float seconds);
// Puts the body's whole island to sleep now.
void force_sleep(RigidWorld& w, Arena& arena, std::uint32_t body);

}  // namespace gyre
