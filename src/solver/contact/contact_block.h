// Blocks of contact constraints for the kernels: W manifolds side by side, none of which shares a movable
// body with another of its colour. Blocks are built at the start of a step in its arena and read back at its
// end; nothing that depends on W outlives the step.
//
// In: ContactConstraint (a manifold, its two bodies and its surface). Out: impulses in the manifolds.
#pragma once

#include "geometry/manifold/manifold.h"
#include "solver/core/body_motion.h"

#include <cstdint>
#include <span>

namespace gyre {

// Contacts without load in the last step, with a soft spring, and in a structure at rest
// (solver/rest/static_equilibrium.h).
enum class ContactStiffness : std::uint8_t { fresh, soft, rigid };

// One manifold to be solved. It is plain data for every width; the kernels read it four floats at a time.
struct ContactConstraint {
  float static_friction = 0.0f;
  float dynamic_friction = 0.0f;
  float rolling_friction = 0.0f;   // m
  float spinning_friction = 0.0f;  // m
  float size = 0.0f;               // m, of the smaller body
  float pushout_speed = 0.0f;      // m/s: the highest speed of pushout
  Vec3 surface_velocity;           // m/s, of b's surface against a's, in the tangent plane
  float restitution = 0.0f;
  std::int32_t body_a = kNoBody;  // index of the motion record; kNoBody for static bodies
  std::int32_t body_b = kNoBody;
  std::int8_t point_count = 0;           // the manifold's
  bool loaded = false;                   // it carried load in the last step
  bool can_roll = false;                 // a curved shape on a flat one
  ContactStiffness stiffness = ContactStiffness::fresh;  // at the beginning of the step
  bool rigid = false;  // without spring: part of a tree that is solved directly, or of a held body
  bool has_joint = false;                // one of the bodies has a joint
  bool speculative = false;              // apart: its features are found anew before it pushes
  bool fast = false;                     // its closing speed may exceed the threshold of hit events
  Manifold* manifold = nullptr;
};
static_assert(sizeof(ContactConstraint) <= 64 || sizeof(void*) != 8, "a cache line");

// Settings of all contacts of a step.
struct ContactSettings {
  float substep = 0.0f;  // s
  float step = 0.0f;     // s
  // A contact that has just begun to carry load is a soft spring. It removes penetration at `rate` (1/s) and
  // yields by the share `compliance` of the load beyond its mean. Both fade with age: to half at `aging`
  // seconds.
  float rate = 0.0f, compliance = 0.0f, aging = 1.0f;
  float warm_scale = 1.0f;  // present sub-step over that of the last step: impulses are stored per sub-step
  Vec3 up;                  // opposite to gravity; zero without gravity
};

// The columns that the kernels read and write.
struct ContactBodies {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;
};

// The impulses of one manifold in a sub-step, for solvers of single contacts.
struct ContactImpulse {
  float normal[kMaxManifoldPoints] = {};
  Vec3 friction;  // on B, in the tangent plane
  float twist = 0.0f;
  Vec3 rolling;
  Vec3 friction_from_b;           // where friction acts (read only)
  float twist_per_normal = 0.0f;  // m, limit of the twist per load (read only)
};

// Arms from both centres of mass to the points of a contact (m, world axes).
struct PointArmPairs {
  Vec3 from_a[kMaxManifoldPoints], from_b[kMaxManifoldPoints];
};

// Arms of a contact whose points move within the step: at the middle of the sub-step, where speeds are taken,
// and at its beginning, where impulses act.
struct AdvancedArms {
  PointArmPairs middle, before, now;  // `before`: at the beginning of the last sub-step
  // m, minus the part that follows from the motion of the bodies since the step began with the arms of the
  // middle.
  float separation[kMaxManifoldPoints] = {};
  // Share of the accumulated friction at each point, written by the kernels. Zeros at the beginning of a
  // step.
  float friction_shares[kMaxManifoldPoints] = {};
  int count = 0;
};

// A contact with moving points: its lane in the block, and the present inverse inertia of its bodies (null
// for none).
struct AdvancedArmsLane {
  int lane;
  AdvancedArms* arms;
  const Sym3 *inverse_a, *inverse_b;
};

// The kernels of contacts of one CPU target. Every function works on blocks [begin, end) of the array at `blocks`. Data
// that only some stages or lanes need is in the array at `cold_blocks`; prepared blocks point to their part
// of it, and to the motion records of their bodies. `order` lists constraint indices block by block, W a
// block; 0xffffffff marks an empty lane. Either all contacts of a block have a body A or none has. Blocks
// without body A have stages of their own, because overflow of a float in between must not depend on the
// neighbouring lanes.
struct ContactKernels {
  std::size_t block_bytes, cold_bytes;
  void (*prepare)(void* blocks, void* cold_blocks, int begin, int end, const ContactConstraint* constraints,
                  const std::uint32_t* order, ContactBodies bodies, const ContactSettings& settings);
  // Moves the points of contacts of a block, and with them the accumulated impulses, whose effect the
  // velocities contain.
  void (*advance_points)(void* blocks, int block, const AdvancedArmsLane* lanes, int count);
  void (*warm_start)(void* blocks, int begin, int end);
  void (*solve)(void* blocks, int begin, int end, float substep);
  // The same once more in a half-step: the sums over the step count the last impulses.
  void (*solve_again)(void* blocks, int begin, int end, float substep);
  // Speculative contacts get no impulse from `solve`. Returns the first block in which some would, or `end`, and those
  // lanes as bits, once.
  int (*find_pushing)(void* blocks, int begin, int end, std::uint32_t& lanes);
  // Solves a speculative contact whose manifold was found anew. From then on it is like any other.
  void (*solve_anew)(void* blocks, int block, int lane, const ContactConstraint& constraint, ContactBodies bodies,
                     const ContactSettings& settings);
  void (*relax)(void* blocks, int begin, int end, float substep);
  // Pushout: motion records hold displacements (m, rad) instead of velocities.
  void (*project)(void* blocks, int begin, int end, float step);
  void (*read_impulse)(const void* blocks, int block, int lane, ContactImpulse& impulse);
  void (*write_impulse)(void* blocks, int block, int lane, const ContactImpulse& impulse);
  // Turns the contact rigid for the rest of the step.
  void (*make_rigid)(void* blocks, int block, int lane);
  void (*finish)(void* blocks, int begin, int end, const ContactConstraint* constraints,
                 const std::uint32_t* order, const ContactSettings& settings);
};

}  // namespace gyre
