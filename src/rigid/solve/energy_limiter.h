// Limits the kinetic energy and keeps the angular momentum of islands with iterative joints or scalar articulations. Passive joints do no
// work. Their linearised rows do when bodies rotate far within a sub-step, and the gain repeats in the next one: nets of rods gained speed
// without end, and a light body with long arms at a limit between heavy ones did so at once. As
// solver/articulation/articulation_energy_kernel.h does for bundles, this unit measures the gain of a sub-step and removes it at the end by
// slowing all inner motion alike. Geometric stiffness (solver/articulation/articulation.cpp, rigid/solve/geometric_stiffness.h) makes a
// body take less angular momentum than its impulses carry; an island that nothing holds gets it back as one rigid body
// (docs/decisions/articulations.md).
#pragma once

#include "rigid/field/fields.h"
#include "rigid/solve/joint_solve.h"

namespace gyre {

struct ActuatedRow;

// The common motions of an island that leave all joint errors unchanged.
enum class IslandFrame : std::uint8_t {
  rigid,     // any rigid motion
  parallel,  // translations: gears and racks count turns
  held,      // only the motion of the carrier
};

// Bodies connected by joints, whose passive rows should do no work.
struct JointIsland {
  std::span<std::uint32_t> bodies;
  std::span<std::uint32_t> joints;  // indices in the batch
  std::span<ActuatedRow> worked;
  IslandFrame frame = IslandFrame::rigid;
  std::int32_t carrier = kNoBody;  // the body that holds them, if it moves
  bool is_pushed = false;          // contacts or fields act between the stages of joints
  bool is_bounded = false;         // the gain was limited before bodies moved
  double energy_gain = 0.0;        // J, by passive rows in this sub-step
  double motor_work = 0.0;         // J, turned over by motors in this sub-step
  double before = 0.0;             // J, before the present stage of joints
  DVec3 spin{};                    // kg m^2/s: angular momentum then, about the first body's centre of mass
};

// Finds the islands of the batch to watch: those with scalar articulations, and those with iterative joints and a body that rotates far.
// The work of springs, motors and drives is measured apart (rigid/solve/actuated_rows.h). An island on a kinematic body is watched in the
// frame of that carrier. An island is left out if several moving bodies hold it, if a body is locked to world axes, or if a grouped
// articulation has drives. Where contacts or fields act, gains are removed only beside fast rotation, because contacts may remove between
// two stages the energy that joints seem to add in one.
//
// `contacts`: pairs of the batch, as for graph colouring. `fields`: the batch's bodies on which fields act.
std::span<JointIsland> find_joint_islands(const JointSolve& solve, std::span<const ColoringPair> contacts,
                                          std::span<const FieldBody> fields, Arena& arena);

// Stages; each block is an island. They run before joints change velocities; the first is for warm starts, which apply impulses again.
void begin_warm_start_energy(const JointSolve& solve, int begin, int end);
void begin_energy_gain(const JointSolve& solve, int begin, int end);
// They run after joints changed velocities: the first before bodies move, the second at the end of the sub-step.
void limit_energy_gain(const JointSolve& solve, int begin, int end);
void remove_energy_gain(const JointSolve& solve, int begin, int end);

// Runs at the end of the step. Where a gain was limited before bodies moved, the next step starts without the impulses that gave it.
void forget_limited_impulses(const JointSolve& solve);

}  // namespace gyre
