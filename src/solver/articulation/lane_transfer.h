// Between the records of joints and the lanes of a bundle of linkages (solver/articulation/articulation_lanes.h): which joints lanes can bear, and
// what goes in as the step begins and comes out as it ends.
#pragma once

#include "solver/joint/joint.h"
#include "solver/articulation/articulation_lanes.h"

namespace gyre {

// How joints go in. `limits_only`: as if each were new and nothing acted on it but limits.
struct LaneStart {
  float warm_scale = 1.0f;  // of impulses
  bool limits_only = false;
  // Of drives: the sub-step, and how soft those are that do not say so.
  float substep = 0.0f;
  Softness softness{};
};

// Whether it is a ball, cone or hinge joint on which nothing acts but what lanes have. Says what that is in `node`. `detail` here and
// below: null if the joint has none.
bool fits_lane(const JointRecord& joint, const JointDetail* detail, const LaneStart& start, LaneNode& node);

// Clears all lanes of a bundle: those that are never set have no bodies.
void clear_lanes(const ArticulationBundle& bundle);
// `is_pressed`: contacts act on it.
void set_lane_body(const ArticulationBundle& bundle, int lane, std::uint32_t body, std::int32_t record,
                   bool is_pressed);
// `offset`: as in JointOffsets.
void load_lane(const ArticulationBundle& bundle, int lane, std::uint32_t node, const JointRecord& joint,
               const JointDetail* detail, Vec3 offset, const LaneStart& start);
// As if all joints were new: none bears an impulse.
void clear_lane_impulses(const ArticulationBundle& bundle);
// Of joints that have just been placed: m or rad, the farthest that a joint or a stop of the lane is off.
float find_lane_error(const ArticulationBundle& bundle, int lane);
// Impulses, sums and positions, back into the joint.
void store_lane(const ArticulationBundle& bundle, int lane, std::uint32_t node, JointRecord& joint,
                JointDetail* detail);

}  // namespace gyre
