// Couplings: a linear equation between axes of joints, as of a mimic joint, a differential or two fingers that close together.
//
// The sum of coefficient times position over all terms is the offset. The solver holds the equation with one force: an axis gets it times its
// coefficient, N or N m, so a coupling does no work. Axes may lie anywhere in one mechanism or in several. docs/joints.md tells the limits.
#pragma once

#include <gyre/ids.h>
#include <gyre/joints.h>

#include <optional>
#include <vector>

namespace gyre {

using CouplingId = Id<struct CouplingTag>;

constexpr int kMaxCouplingTerms = 8;

// An axis of a hinge (angular_x), a slider (linear_x), a universal joint, a wheel or a six_dof joint that is not locked.
struct CouplingTerm {
  JointId joint{};
  JointAxis axis = JointAxis::angular_x;
  float coefficient = 1.0f;  // not 0; per rad or per m
};

// Examples: b follows a at half the angle: {{b, ..., 1}, {a, ..., -0.5}}. A differential: {{left, ..., 1}, {right, ..., 1}, {shaft, ..., -2}}.
struct CouplingDef {
  std::vector<CouplingTerm> terms{};  // 2 to kMaxCouplingTerms; no axis twice
  std::optional<float> offset{};      // of the sum; none = the present sum
};

struct CouplingState {
  float error = 0;  // the sum less the offset
  float force = 0;  // mean over the last step: each axis gets it times its coefficient, N or N m
};

}  // namespace gyre
