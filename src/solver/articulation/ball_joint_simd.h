// Iterative ball joints side by side: joints of a colour share no movable body, so W of them are solved at
// once. Only for ball joints on which nothing else acts, as in nets and grids; others are solved one by one.
// The arithmetic is that of prepare_joint(), update_joint_bias(), warm_start_joint(), solve_joint() and
// accumulate_joint_impulses() of solver/joint/joint.h, so a lane has the bits of a joint alone.
#pragma once

#include "solver/core/body_motion.h"

#include <cstddef>

namespace gyre {

// A joint as one lane, with floats in the order of the kernels'.
struct LaneBall {
  Vec3 local_a, local_b;  // anchors from the centres of mass, body frames
  Vec3 offset;            // JointOffsets::offset
  Vec3 total;             // linear impulse, summed over the step
  Vec3 from_a, from_b;    // of this sub-step: anchors from the centres of mass, world axes
  Vec3 impulse;           // linear
  Vec3 error, second_order_bias;       // as JointConstraint
};

// How a lane reads the inertia of its bodies: not at all; once, as it is constant; or each time, as it
// rotates.
constexpr std::int32_t kInertiaKnown = 0, kInertiaConstant = 1, kInertiaRotates = 2;

// Motion records of its bodies, or kNoBody; for writing kNoBody if the body is not movable.
struct LaneBallBodies {
  std::int32_t read_a = kNoBody, read_b = kNoBody, write_a = kNoBody, write_b = kNoBody;
  std::int32_t inertia = kInertiaConstant;
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

// The kernels of one CPU target, on blocks [begin, end). A block begins with the lanes' LaneBallBodies (all
// read_a, all read_b, ...), followed at `first_float` bytes by the floats of LaneBall, W of each.
struct BallKernels {
  int width;
  std::size_t block_bytes, first_float;
  // Finds the motion records of all lanes, which must not move afterwards. Comes first.
  void (*locate)(void* blocks, int begin, int end, const BallArrays& arrays);
  void (*prepare)(void* blocks, int begin, int end, const BallArrays& arrays);
  void (*update_bias)(void* blocks, int begin, int end, const BallSettings& settings);
  void (*warm_start)(void* blocks, int begin, int end);
  void (*solve)(void* blocks, int begin, int end, const BallSettings& settings);
  // Removes all speed, and sums the impulses.
  void (*relax)(void* blocks, int begin, int end);
};

}  // namespace gyre
