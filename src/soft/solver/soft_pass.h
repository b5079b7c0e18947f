// The pass of a body that all kernels share, and the loops over its slices.
#pragma once

#include "base/arena/arena.h"
#include "soft/body/soft_body.h"
#include "soft/kernels/soft_kernels.h"
#include "task/task_system.h"

namespace gyre {

// Slices that one worker takes at a time, and whose sums are added up by themselves.
constexpr int kBlockSlices = 16;

VectorRows make_vectors(Arena& arena, std::size_t rows);
// With the body's own columns and patterns, and memory for forces; the rest is the caller's to set.
SoftPass begin_pass(SoftBody& body, Arena& arena);
// The forces of everything that holds the body together, in pass.force.
void find_forces(const SoftPass& pass, const SoftBody& body, const SoftKernels& kernels, TaskSystem& tasks);
// These, and the matrix, whose memory the pass has.
void linearize(const SoftPass& pass, const SoftBody& body, const SoftKernels& kernels, TaskSystem& tasks);
// Puts held particles where they are told to be.
void place_held(SoftBody& body);

}  // namespace gyre
