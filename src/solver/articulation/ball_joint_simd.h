// Ball joints that are swept, side by side: those of a colour share no moving body, so W of them are solved at once. For ball
// joints on which nothing else acts, which are what nets and grids are made of; the others are solved one by one. The same
// arithmetic as prepare_joint(), update_joint_bias(), warm_start_joint(), solve_joint() and accumulate_joint_impulses() of solver/joint/joint.h, so a lane has
// the bits that the joint has alone.
#pragma once

#include "solver/core/body_motion.h"

#include <cstddef>

namespace gyre {

// A joint as one lane. The floats are in the order of the kernels'.
struct LaneBall {
  Vec3 local_a, local_b;  // anchors from the centres of mass, body frames
  Vec3 offset;            // JointOffsets::offset
  Vec3 total;             // linear impulse, summed over the step
  Vec3 from_a, from_b;    // of this sub-step: anchors from the centres of mass, world axes
  Vec3 impulse;           // linear
  Vec3 error, second_order_bias;  // as JointConstraint
};

// What a lane has still to read of its bodies' inertia: nothing; once, as it stays; or each time, as it turns with them.
constexpr std::int32_t kInertiaKnown = 0, kInertiaStays = 1, kInertiaRotates = 2;

// Who it joins: motion records, or kNoBody; for writing kNoBody where nothing pushes the body.
struct LaneBallBodies {
  std::int32_t read_a = kNoBody, read_b = kNoBody, write_a = kNoBody, write_b = kNoBody;
  std::int32_t inertia = kInertiaStays;
};

struct BallArrays {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;
  const Quat* orientation = nullptr;
};
// As Softness.
struct BallSettings {
  float substep = 0.0f;
  float rate = 0.0f, mass_scale = 1.0f, impulse_scale = 0.0f;
};

// The kernels of one CPU target, on blocks [begin, end). A block begins with the lanes' LaneBallBodies (all read_a, all read_b,
// ...), then come the floats of LaneBall, W of each, from `first_float` bytes on.
struct BallKernels {
  int width;
  std::size_t block_bytes, first_float;
  // Finds the motion records of all lanes, which then stay where they are. Comes first.
  void (*locate)(void* blocks, int begin, int end, const BallArrays& arrays);
  void (*prepare)(void* blocks, int begin, int end, const BallArrays& arrays);
  void (*update_bias)(void* blocks, int begin, int end, const BallSettings& settings);
  void (*warm_start)(void* blocks, int begin, int end);
  void (*solve)(void* blocks, int begin, int end, const BallSettings& settings);
  // Takes all speed away, and sums the impulses.
  void (*relax)(void* blocks, int begin, int end);
};

}  // namespace gyre
