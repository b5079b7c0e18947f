// Continuous collision: bodies that move so far in one step that they could pass through something are taken back to
// where they first meet it.
//
// In: bodies as the step began and how far the solver moved them; the broad phase as it was then. Out: for each fast body
// the fraction of its motion to keep (pose_at(sweep, fraction) is where it meets something), and a way along what it met on
// which it spends the rest of its step. It is left a small part of its size short of touching, where the next step's contacts
// find it; its velocity stays, and they answer to it.
//
// What a shape touches as the step begins must not hold it: a body that slides would freeze at every step. The solver
// answers for such pairs; only the core, the shape with half of its inner radius taken off all around, is swept against them,
// so that no part of it passes. In a mesh or height field this holds for each plane of its triangles by itself.
//
// Sensors hold nothing up. What has passed through one within the step is told as a crossing, because no look between steps
// would see it.
#pragma once

#include "base/container/bitset.h"
#include "base/function_ref.h"
#include "collision/broadphase/broadphase.h"
#include "collision/contact/collide.h"
#include "collision/contact/pair_update.h"
#include "collision/continuous/swept_surface.h"

#include <memory>
#include <span>

namespace gyre {

// A body that may have gone too far.
struct FastBody {
  std::uint32_t body = 0;
  bool continuous = false;    // also against dynamic bodies (always against fixed and kinematic ones)
  float min_fraction = 0.0f;  // part of its way that it keeps in any case, if its core can
  bool slides = true;         // goes on along what it met; not what hangs on joints, which know nothing of it
  bool only_crosses = false;  // nothing stops it: only what it crosses is told
};

// What a fast body keeps of its motion: a fraction of it (1 where nothing is in the way), and then a way along what it met and
// with it.
struct SavedMotion {
  float fraction = 1.0f;
  Vec3 slide;  // m, of the centre of mass
  Vec3 rotation;  // rad, rotation vector, world: what it met turned it along
  // Where the core was in the way, although the shape was in touch already: the solver did not hold it there. Whoever moves
  // the body must take its speed into `other` at that point.
  Vec3 impact_normal;       // unit, from the body to the other; zero: there was none
  DVec3 impact_point;       // world
  std::uint32_t other = 0;  // body
};

// A visitor that a fast body carried through a sensor, or was passed by one: shapes, as the key to sort by.
inline std::uint64_t crossing_key(std::uint32_t sensor, std::uint32_t visitor) {
  return std::uint64_t(sensor) << 32 | visitor;
}

// Whether a motion is far enough to look at: more than this share of the inner radius of the body's thinnest shape.
constexpr float kFastShare = 0.5f;
inline bool is_fast(Vec3 translation, Vec3 rotation, float bounding_radius, float inner) {
  return length(translation) + length(rotation) * bounding_radius > kFastShare * inner;
}

// A box around the whole way of a shape, turning included.
Aabb bounds_of_sweep(const ColliderShape& shape, const Sweep& sweep);

// A surface that moves by itself and a convex shape on its way, one of them a sensor: shapes. The surface is not swept itself.
struct GatePair {
  std::uint32_t convex = 0, surface = 0;
};

// What contacts tell of what is near.
struct KnownContacts {
  const ContactStore& store;  // of all pairs that the broad phase knows
  // Which of them are with what is not pushed, or with a sensor (TouchChanges::may_stop), and which shapes have one.
  const Bitset& ccd_blockers;
  const Bitset& near_blockers;
};

struct ContinuousInput {
  ColliderShapes shapes;
  std::span<const Proxy> proxies;  // as the broad phase last saw them
  const Broadphase& broadphase;
  const BlockedBodies& blocked;
  // The motion of any body in this step (no motion for those that rest), and the shapes of a fast one. Called from any
  // worker.
  FunctionRef<Sweep(std::uint32_t body)> sweep_of;
  FunctionRef<std::span<const std::uint32_t>(std::uint32_t body)> shapes_of;
  // Whether the shape in the way lets pass what moves so against it; null: none does.
  const FunctionRef<bool(std::uint32_t shape, Vec3 translation)>* lets_pass = nullptr;
  std::span<const GatePair> gates{};
  const KnownContacts* contacts = nullptr;  // null: not kept
};

class ContinuousCollision {
 public:
  // kept[i] of the motion of fast[i] is to be kept. Parallel over bodies.
  void clamp_fast_bodies(const ContinuousInput& input, std::span<const FastBody> fast, TaskSystem& tasks,
                         std::span<SavedMotion> saved);
  // Of the last call: crossing_key of each sensor and visitor, in rising order, also of pairs that overlapped from the
  // start.
  std::span<const std::uint64_t> crossings() const { return crossings_; }

 private:
  struct Worker {
    Array<std::uint32_t> found;
    Array<std::uint64_t> crossings;
    std::unique_ptr<TriangleHull> triangle = std::make_unique<TriangleHull>();
  };
  void gather_crossings();
  void even_out_room();
  void test_gates(const ContinuousInput& input);

  Array<Worker> workers_;
  Array<std::uint64_t> crossings_, sort_scratch_;
};

}  // namespace gyre
