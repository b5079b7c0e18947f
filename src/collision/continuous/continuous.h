// Continuous collision detection (CCD): bodies that move so far in one step that they could pass through something are
// moved back to their time of impact.
//
// In: bodies as the step began, their motion by the solver, and the broad phase of that time. Out: for each fast body
// the fraction of its motion to keep (pose_at(sweep, fraction) is the impact), and a displacement along the obstacle
// for the rest of the step. The body stops a small share of its size short of touching, where the contacts of the next
// step find the obstacle. It keeps its velocity; those contacts respond to it.
//
// A shape must not be halted by what it touches as the step begins, or a sliding body would freeze in every step. The
// solver handles such pairs; only the core (the shape with half of its inner radius removed all around) is swept
// against them, so that it cannot pass. In a mesh or height field this holds for each plane of its triangles. The same
// holds for a shape behind an internal edge (contact/internal_edges.h): a body that slides over flush tiles sinks in by a
// trace, and the side of the next tile must not halt it.
//
// Sensors halt nothing. A body that passed through a sensor within the step is reported as a crossing, because updates
// between steps would not see it.
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

// A body whose motion CCD must test.
struct FastBody {
  std::uint32_t body = 0;
  bool continuous = false;    // also against dynamic bodies (always against fixed and kinematic ones)
  float min_fraction = 0.0f;  // fraction of its motion that it keeps in any case, if its core is free
  // slides along the obstacle; false for bodies with joints, whose joints know nothing of it
  bool slides = true;
  bool only_crosses = false;  // never halted; only its crossings are reported
};

// The motion that a fast body keeps: a fraction of its sweep (1 if nothing blocks it), then a displacement along the
// obstacle and with it.
struct SavedMotion {
  float fraction = 1.0f;
  Vec3 slide;     // m, of the centre of mass
  Vec3 rotation;  // rad, rotation vector, world: rotation of the obstacle that carries the body
  // Set if the core was blocked although the shape was in touch already, so that the solver did not hold the body
  // there. The caller must transfer the body's momentum to `other` at this point.
  Vec3 impact_normal;       // unit, from the body to the other; zero: none
  DVec3 impact_point;       // world
  std::uint32_t other = 0;  // body
};

// A crossing of a sensor and another shape, as a sort key.
inline std::uint64_t crossing_key(std::uint32_t sensor, std::uint32_t visitor) {
  return std::uint64_t(sensor) << 32 | visitor;
}

// A motion is fast if it exceeds this share of the inner radius of the body's thinnest shape.
constexpr float kFastShare = 0.5f;
inline bool is_fast(Vec3 translation, Vec3 rotation, float bounding_radius, float inner) {
  return length(translation) + length(rotation) * bounding_radius > kFastShare * inner;
}

// A box around the whole sweep of a shape, rotation included.
Aabb bounds_of_sweep(const ColliderShape& shape, const Sweep& sweep);

// A moving surface and a convex shape, one of them a sensor, as shape indices. The surface itself is not swept.
struct GatePair {
  std::uint32_t convex = 0, surface = 0;
};

// The contacts, which tell what is near.
struct KnownContacts {
  const ContactStore& store;  // of all pairs that the broad phase knows
  // The contacts with shapes that are not pushed, or sensors (TouchChanges::ccd_blockers), and the shapes that have
  // one.
  const Bitset& ccd_blockers;
  const Bitset& near_blockers;
  const Bitset& hidden;  // contacts with manifolds at internal edges in this step (InternalEdgeScratch::hidden)
};

struct ContinuousInput {
  ColliderShapes shapes;
  std::span<const Proxy> proxies;  // as the broad phase last got them
  const Broadphase& broadphase;
  const BlockedBodies& blocked;
  // The motion of any body in this step (none for bodies at rest), and the shapes of a fast body. Called from any
  // worker.
  FunctionRef<Sweep(std::uint32_t body)> sweep_of;
  FunctionRef<std::span<const std::uint32_t>(std::uint32_t body)> shapes_of;
  // True if the shape is a one-way platform that lets this relative translation pass. Null: there are none.
  const FunctionRef<bool(std::uint32_t shape, Vec3 translation)>* lets_pass = nullptr;
  std::span<const GatePair> gates{};
  const KnownContacts* contacts = nullptr;  // null: not available
};

class ContinuousCollision {
 public:
  // saved[i] receives the motion that fast[i] keeps. Parallel over bodies.
  void clamp_fast_bodies(const ContinuousInput& input, std::span<const FastBody> fast, TaskSystem& tasks,
                         std::span<SavedMotion> saved);
  // Crossings of the last call: crossing_key of each sensor and visitor, ascending, including pairs that overlapped
  // from the start.
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
