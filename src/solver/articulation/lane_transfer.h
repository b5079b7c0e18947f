// Copies joints between their records and the lanes of a bundle of articulations
// (solver/articulation/articulation_lanes.h), and decides which joints fit in lanes.
#pragma once

#include "solver/articulation/articulation_lanes.h"
#include "solver/joint/joint.h"

namespace gyre {

// Input of lanes. `limits_only`: as if each joint were new and had only limits.
struct LaneStart {
  float warm_scale = 1.0f;  // of impulses
  bool limits_only = false;
  // For drives: the sub-step, and the softness of those without one.
  float substep = 0.0f;
  Softness softness{};
};

// True for a ball, cone or hinge joint with nothing that lanes do not have; describes it in `node`. `detail`
// here and below: null if the joint has none.
bool fits_lane(const JointRecord& joint, const JointDetail* detail, const LaneStart& start, LaneNode& node);

// Clears all lanes of a bundle: lanes that are never set have no bodies.
void clear_lanes(const ArticulationBundle& bundle);
// `is_pressed`: contacts act on it.
void set_lane_body(const ArticulationBundle& bundle, int lane, std::uint32_t body, std::int32_t record,
                   bool is_pressed);
// `offset`: as in JointOffsets.
void load_lane(const ArticulationBundle& bundle, int lane, std::uint32_t node, const JointRecord& joint,
               const JointDetail* detail, Vec3 offset, const LaneStart& start);
// Clears all impulses, as if all joints were new.
void clear_lane_impulses(const ArticulationBundle& bundle);
// After preparation: m or rad, the largest error of a joint or limit of the lane.
float find_lane_error(const ArticulationBundle& bundle, int lane);
// Stores impulses, sums and positions in the joint.
void store_lane(const ArticulationBundle& bundle, int lane, std::uint32_t node, JointRecord& joint,
                JointDetail* detail);

}  // namespace gyre
