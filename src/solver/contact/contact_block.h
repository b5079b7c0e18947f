// Contacts as the kernels solve them: W manifolds side by side, none of which shares a moving body with another of its
// colour. Blocks are built at the start of each step in the step's arena and read back at its end; nothing that depends
// on W outlives the step.
//
// In: ContactConstraint (a manifold, its two bodies and its surface). Out: impulses in the manifolds.
#pragma once

#include "geometry/manifold/manifold.h"
#include "solver/articulation/ball_joint_simd.h"
#include "solver/articulation/articulation_lanes.h"
#include "solver/core/body_motion.h"
#include "solver/motion/motion_block.h"
#include "solver/motion/rotation_block.h"

#include <cstdint>
#include <span>

namespace gyre {

// Whether a contact has borne load as a spring, or is held as part of a structure at rest (solver/rest/static_equilibrium.h).
enum class ContactStiffness : std::uint8_t { fresh, soft, rigid };

// One manifold to be solved. Plain data: the same for every width; the kernels read it four floats at a time.
struct ContactConstraint {
  float static_friction = 0.0f;
  float dynamic_friction = 0.0f;
  float rolling_friction = 0.0f;   // m
  float spinning_friction = 0.0f;  // m
  float size = 0.0f;               // m, of the smaller body
  float pushout_speed = 0.0f;         // m/s: the fastest that overlap is taken back
  Vec3 surface_velocity;           // m/s, of b's surface against a's, in the tangent plane
  float restitution = 0.0f;
  std::int32_t body_a = kNoBody;  // index of the motion record; kNoBody for fixed bodies
  std::int32_t body_b = kNoBody;
  std::int16_t point_count = 0;          // the manifold's
  bool loaded = false;                   // it bore load in the last step
  bool can_roll = false;                 // of a curved shape with a flat one
  bool rigid = false;                    // no spring: part of a tree that is solved directly
  bool has_joint = false;                   // one of the bodies hangs on a joint
  bool fast = false;                     // closes so fast that it may be told as a hit
  ContactStiffness stiffness = ContactStiffness::fresh;  // as the step began
  Manifold* manifold = nullptr;
};
static_assert(sizeof(ContactConstraint) <= 64 || sizeof(void*) != 8, "a cache line");

// What is the same for all contacts of a step.
struct ContactSettings {
  float substep = 0.0f;  // s
  float step = 0.0f;     // s
  // A contact that has just begun to bear load is a soft spring: it asks overlap back at `rate` (1/s) and gives way by the
  // share `give` of the load it is not used to. Both fade as it ages: at `aging` seconds to half.
  float rate = 0.0f, compliance = 0.0f, aging = 1.0f;
  float warm_scale = 1.0f;  // present sub-step over the last step's: impulses are kept per sub-step
  Vec3 up;                  // against gravity; zero where there is none
};

// The body arrays that the kernels work on.
struct ContactBodies {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;
};

// The impulses of one manifold in a sub-step, for solvers that look at single contacts.
struct ContactImpulse {
  float normal[kMaxManifoldPoints] = {};
  Vec3 friction;  // on B, in the tangent plane
  float twist = 0.0f;
  Vec3 rolling;
  Vec3 friction_from_b;           // where the friction acts (read only)
  float twist_per_normal = 0.0f;  // m, limit of the twist (read only)
};

// From both centres of mass to the points of a contact (m, world axes).
struct PointArmPairs {
  Vec3 from_a[kMaxManifoldPoints], from_b[kMaxManifoldPoints];
};

// Where the points of a contact are in a sub-step, if not where they were as the step began: in its middle, where speeds are
// taken, and as it begins, where impulses act.
struct AdvancedArms {
  PointArmPairs middle, before, now;  // `before`: as the last sub-step began
  // m, less what the bodies' motion since the step began makes of it with the arms of the middle.
  float separation[kMaxManifoldPoints] = {};
  // Of the friction that stands, how much acts at each point: kernels note it. Zeros where the step has just begun.
  float friction_shares[kMaxManifoldPoints] = {};
  int count = 0;
};

// A contact that is followed: its lane in the block, and the present inverse inertia of its bodies, null where there is none.
struct AdvancedArmsLane {
  int lane;
  AdvancedArms* arms;
  const Sym3 *inverse_a, *inverse_b;
};

// The kernels of one CPU target: every function works on blocks [begin, end) of the array at `blocks`. What only some stages or lanes need
// of them is in another array, at `asides`: prepared blocks know their part of it. `order` lists constraint indices block by block, W a block;
// 0xffffffff marks an empty lane. Of a block either all
// contacts have a body A or none has: the latter have steps of their own, and whether a number leaves a float's range on the way must
// not depend on the lanes beside it. What is prepared knows where the motion records of its
// bodies lie.
struct ContactKernels {
  int width;
  std::size_t block_bytes, cold_bytes;
  void (*prepare)(void* blocks, void* cold_blocks, int begin, int end, const ContactConstraint* constraints,
                  const std::uint32_t* order, ContactBodies bodies, const ContactSettings& settings);
  // Moves the points of contacts of a block, and along with them the impulses that stand, which these velocities have.
  void (*advance_points)(void* blocks, int block, const AdvancedArmsLane* lanes, int count);
  void (*warm_start)(void* blocks, int begin, int end);
  void (*solve)(void* blocks, int begin, int end, float substep);
  void (*relax)(void* blocks, int begin, int end, float substep);
  // Pushes what overlaps apart; motion records hold displacements (m, rad) in the place of velocities.
  void (*project)(void* blocks, int begin, int end, float step);
  void (*read_impulse)(const void* blocks, int block, int lane, ContactImpulse& impulse);
  void (*write_impulse)(void* blocks, int block, int lane, const ContactImpulse& impulse);
  // From now on the contact is no spring in this step.
  void (*make_rigid)(void* blocks, int block, int lane);
  void (*finish)(void* blocks, int begin, int end, const ContactConstraint* constraints,
                 const std::uint32_t* order, const ContactSettings& settings);
  MotionKernels motion;
  RotationKernels rotation;
  ArticulationKernels articulations;
  BallKernels balls;
};

// The widest kernels that this machine runs well and that have at most `width` lanes (0: any). Same bits whichever.
const ContactKernels& select_contact_kernels(int width);
// Those of half as many lanes, for what would leave the others idle; `kernels` itself where there are none of the same instructions.
const ContactKernels& narrower_kernels(const ContactKernels& kernels);

}  // namespace gyre
