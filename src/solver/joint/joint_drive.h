// Drives of a joint to a pose, and friction against all of its turning: three rows at once, each impulse held within a
// ball rather than a box, so that no direction is stronger than another.
#pragma once

#include "solver/joint/joint.h"

namespace gyre {

bool has_drive(const JointDetail& detail);
void prepare_drive(const JointConstraint& work, const JointPair& pair, const JointSettings& settings);
void warm_start_drive(const JointConstraint& work, JointPair& pair);
void solve_drive(const JointConstraint& work, JointPair& pair, const JointSettings& settings);
void accumulate_drive(JointRecord& joint, const JointDetail& detail);

}  // namespace gyre
