// Joints: the record that persists, what preparation finds out in each sub-step, and the solve over a run of joints.
// Every kind is made of the blocks in joint_blocks.h.
//
// Frames: a joint has a frame on each body (origin at the anchor, x along the axis). The error of a joint is measured with
// the orientations of the sub-step, its rows are solved softly (position errors are taken back) and then rigidly (only
// velocities), as contacts are.
#pragma once

#include "solver/body_motion.h"
#include "solver/softness.h"

#include <gyre/defs.h>

#include <cstdint>
#include <span>

namespace gyre {

// A joint as it persists from step to step: part of the world's state.
struct JointRecord {
  JointKind kind = JointKind::ball;
  bool has_limits = false;
  bool is_spring = false;        // distance with stiffness
  bool collide_connected = false;
  bool has_motor_target = false;
  std::int32_t body_a = kNoBody;
  std::int32_t body_b = kNoBody;
  Vec3 local_anchor_a;           // from the centre of mass, body frame
  Vec3 local_anchor_b;
  Quat local_frame_a;            // body_from_joint
  Quat local_frame_b;
  DVec3 world_anchor_a;          // where the anchor is when that body is the world
  DVec3 world_anchor_b;
  Limits limits;                 // rad or m
  float motor_velocity = 0.0f;   // target
  float motor_position = 0.0f;   // target, if has_motor_target
  float motor_force = 0.0f;      // 0: no motor
  float motor_frequency = 0.0f;
  float motor_damping = 1.0f;
  float rest_length = 0.0f;      // distance: m; of the spring
  float min_length = 0.0f;
  float max_length = 0.0f;
  float stiffness = 0.0f;
  float damping = 0.0f;
  float break_force = 0.0f;      // 0: unbreakable
  float break_torque = 0.0f;
  // Impulses of the last sub-step, world axes, on B: the warm start.
  Vec3 linear_impulse;
  Vec3 angular_impulse;
  float low_impulse = 0.0f;      // limits
  float high_impulse = 0.0f;
  float motor_impulse = 0.0f;
  float spring_impulse = 0.0f;
  float position = 0.0f;         // unwrapped angle, slide or length
  // Sums over the last step, for reading.
  Vec3 total_linear;
  Vec3 total_angular;
};

// max_length of a joint without one.
constexpr float kUnlimitedLength = 1.0e30f;

// What a step knows about one joint: the difference of the anchors' owners' centres, exact at any distance from the origin.
struct JointPlaces {
  Vec3 offset;  // centre (or world anchor) of b minus that of a, as the step began
};

// The columns that joints are solved on, indexed by body.
struct JointBodies {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;     // of this sub-step
  const Quat* orientation = nullptr;        // of this sub-step: world_from_body
};

struct JointSettings {
  float substep = 0.0f;
  Softness softness;  // of the joint's own rows
  bool swept = true;  // false: the rows of the joint's equations are solved elsewhere (solver/linkage.h)
};

// One joint in one sub-step, prepared. Lives in the step's arena.
struct JointWork {
  Vec3 from_a, from_b;       // anchors from the centres of mass, world axes
  Vec3 error;                // anchor b minus anchor a
  Vec3 bend;                 // m/s: how far b's anchor leaves a's by turning in the sub-step, beyond what the rows see
  Vec3 axis;                 // hinge and slider: of a; distance: unit from a to b
  Vec3 perpendicular_1, perpendicular_2;
  Vec3 angular_error;        // rotation vector that turns a's frame onto b's
  Mat3 linear_mass;          // inverse of K
  Mat3 angular_mass;
  float axis_bend = 0.0f;    // m/s: the same for the distance
  float axis_mass = 0.0f;    // effective mass of the motion along or about the axis
  float position = 0.0f;
  float spring_position = 0.0f;  // speed asked for by the spring's displacement
  float spring_damping = 0.0f;   // share of the relative speed taken away
  Softness spring;               // stiff springs: implicit
  bool spring_is_stiff = false;
};

// Takes everything away that the last step left in the record: the joint goes on as if it were new.
void forget_impulses(JointRecord& joint);
// Scales the kept impulses to a new sub-step length and clears the sums; once a step.
void begin_joint(JointRecord& joint, JointWork& work, float warm_scale);
// What depends on where the bodies are: once they have moved.
void place_joint(JointRecord& joint, JointWork& work, const JointPlaces& places, const JointBodies& bodies,
                 const JointSettings& settings);
// What depends on their velocities: before they are solved.
void bend_joint(const JointRecord& joint, JointWork& work, const JointBodies& bodies,
                const JointSettings& settings);
void warm_start_joint(const JointRecord& joint, const JointWork& work, const JointBodies& bodies);
void solve_joint(JointRecord& joint, const JointWork& work, const JointBodies& bodies,
                 const JointSettings& settings, bool soft);
// Only the limits and the motor along or about the axis of a slider or hinge.
void warm_start_joint_axis(const JointRecord& joint, const JointWork& work, const JointBodies& bodies);
void solve_joint_axis(JointRecord& joint, const JointWork& work, const JointBodies& bodies,
                      const JointSettings& settings, bool soft);
// Adds the sub-step's impulses to the sums.
void sum_joint(JointRecord& joint, const JointWork& work);

}  // namespace gyre
