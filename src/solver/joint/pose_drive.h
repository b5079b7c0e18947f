// Pose drives of a joint, and friction against all of its rotation. Three rows are solved at once. Their
// impulse is bounded by a ball instead of a box, so no direction is stronger than another.
#pragma once

#include "solver/joint/joint.h"

namespace gyre {

bool has_drive(const JointDetail& detail);
void prepare_drive(const JointConstraint& work, const JointPair& pair, const JointSettings& settings);
void warm_start_drive(const JointConstraint& work, JointPair& pair);
void solve_drive(const JointConstraint& work, JointPair& pair, const JointSettings& settings);
void accumulate_drive(JointRecord& joint, const JointDetail& detail);

}  // namespace gyre
