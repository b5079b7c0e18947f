// What joints that are swept, or in articulations that are solved alone, give of energy and of angular momentum. Joints that only connect do no work;
// where bodies turn far within a sub-step their rows, linear in what turns, do all the same, and what they give in one they give again in
// the next: nets of rods went faster without end; where a light body with long arms strikes a stop between heavy ones, at once. As
// solver/articulation/articulation_energy_kernel.h does it for articulations side by side, what joints have given in a sub-step is taken away as it ends,
// by slowing all inner motion alike. And where inertia against joints is raised (solver/articulation/articulation.cpp, rigid/solve/geometric_stiffness.h) a body does not
// take all of a turn that others gave: what hangs on nothing gets it back, as one rigid body (docs/decisions/articulations.md).
#pragma once

#include "rigid/field/fields.h"
#include "rigid/solve/joint_solve.h"

namespace gyre {

struct ActuatedRow;

// What motion of all bodies together the joints of an island see nothing of.
enum class IslandFrame : std::uint8_t {
  rigid,     // any as one rigid body
  parallel,  // any without turning: gears and racks count turns
  held,      // none but that of what holds them
};

// Bodies that hang together by joints that should do no work, but for some of their rows (rigid/solve/energy_limiter.h).
struct JointIsland {
  std::span<std::uint32_t> bodies;
  std::span<std::uint32_t> joints;  // indices in the batch
  std::span<ActuatedRow> worked;
  IslandFrame frame = IslandFrame::rigid;
  std::int32_t carrier = kNoBody;  // what holds them, if that moves
  bool is_pushed = false;          // contacts or fields act on it between what joints do
  bool is_bounded = false;         // joints gave more than is borne before bodies move
  double energy_gain = 0.0;        // J, in this sub-step, by what rows that do no work changed of velocities,
  double before = 0.0;             // and what there was before they last did;
  DVec3 spin{};  // kg m^2/s: the angular momentum then, about the first body's centre of mass
};

// Those of the batch: bodies that hang together by joints, some of them swept or in articulations that are solved alone; of those that are
// swept, where a body turns far. What springs, motors and drives do is told apart (rigid/solve/actuated_rows.h). What a
// kinematic body holds is seen from that. Not where several that move hold it, where a body is bound to axes of the world, or where a linkage
// in lanes is driven. Where contacts or fields act, gains are taken away only beside what turns far: they may answer between two stages what
// joints seem to give in one.
// `contacts`: of the batch, as the colouring knows them. `fields`: the batch's bodies on which fields act.
std::span<JointIsland> find_joint_islands(const JointSolve& solve, std::span<const ColoringPair> contacts,
                                          std::span<const FieldBody> fields, Arena& arena);

// Stages, whose blocks are islands. Before what joints change of velocities; warm start: where impulses are given once more.
void begin_warm_start_energy(const JointSolve& solve, int begin, int end);
void begin_energy_gain(const JointSolve& solve, int begin, int end);
// After it: before bodies move, and as the sub-step ends.
void limit_energy_gain(const JointSolve& solve, int begin, int end);
void remove_energy_gain(const JointSolve& solve, int begin, int end);

// As the step ends: where speeds were bounded before bodies moved, the next one does not begin with the impulses that gave them.
void forget_limited_impulses(const JointSolve& solve);

}  // namespace gyre
