// Between the records of joints and the lanes of ball joints side by side (solver/articulation/ball_joint_simd.h).
#pragma once

#include "solver/articulation/ball_joint_simd.h"
#include "solver/joint/joint.h"

namespace gyre {

// Whether it is a ball joint on which nothing else acts.
bool fits_ball_lane(const JointRecord& joint, const JointDetail* detail);

// A block whose lanes join nothing.
void clear_balls(const BallKernels& kernels, void* blocks, int block);
// `offset`: as in JointOffsets. `warm_scale`: of its impulse, if begin_joint() did not see to that. `turns`: the inertia of one of its bodies turns with it.
void begin_ball(const BallKernels& kernels, void* blocks, int block, int lane, const JointRecord& joint,
                Vec3 offset, float warm_scale, bool inertia_rotates, const BodyInertia* inertia);
// Impulses and sums, back into the record.
void finish_ball(const BallKernels& kernels, const void* blocks, int block, int lane, JointRecord& joint);

}  // namespace gyre
