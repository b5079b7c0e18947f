// Copies ball joints between their records and the lanes of solver/articulation/ball_joint_simd.h.
#pragma once

#include "solver/articulation/ball_joint_simd.h"
#include "solver/joint/joint.h"

namespace gyre {

// True for a ball joint on which nothing else acts.
bool fits_ball_lane(const JointRecord& joint, const JointDetail* detail);

// A block without joints.
void clear_balls(const BallKernels& kernels, void* blocks, int block);
// `offset`: as in JointOffsets. `warm_scale`: of its impulse, if begin_joint() has not scaled it.
// `inertia_rotates`: the inertia of one of its bodies rotates with it.
void begin_ball(const BallKernels& kernels, void* blocks, int block, int lane, const JointRecord& joint,
                Vec3 offset, float warm_scale, bool inertia_rotates, const BodyInertia* inertia);
// Stores impulses and sums in the record.
void finish_ball(const BallKernels& kernels, const void* blocks, int block, int lane, JointRecord& joint);

}  // namespace gyre
