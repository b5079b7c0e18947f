// What the program of a batch works on: its constraints and bodies, and both as the kernels want them. Gathered by solve_gather.h and
// solve_bodies.h, laid out by solve_layout.h.
#pragma once

#include "rigid/articulation/articulations.h"
#include "rigid/batch/solve_batches.h"
#include "rigid/batch/worker_partition.h"
#include "rigid/field/fields.h"
#include "rigid/integrate/integrators.h"
#include "rigid/integrate/smooth_motion.h"
#include "rigid/rest/resting_structures.h"
#include "rigid/rest/resting_trees.h"
#include "rigid/solve/fused_stages.h"
#include "rigid/solve/rolling_contacts.h"
#include "rigid/solve/solve_step.h"

namespace gyre {

struct Group;

// A body of which joints ask more than a sub-step resolves (rigid/solve/geometric_stiffness.h).
struct StiffenedBody {
  std::uint32_t body = 0;
  float raise = 0.0f;  // kg m^2, about every axis
};

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
  std::span<std::uint32_t> joints;  // places in the batch
  std::span<ActuatedRow> worked;
  IslandFrame frame = IslandFrame::rigid;
  std::int32_t carrier = kNoBody;         // what holds them, if that moves
  bool is_pushed = false;                 // contacts or fields act on it between what joints do
  bool is_bounded = false;                // joints gave more than is borne before bodies move
  double energy_gain = 0.0;  // J, in this sub-step, by what rows that do no work changed of velocities,
  double before = 0.0;                    // and what there was before they last did;
  DVec3 spin{};  // kg m^2/s: the angular momentum then, about the first body's centre of mass
};

// What every stage of the program reads.
struct BatchContext {
  RigidWorld& w;
  BatchScratch& scratch;
  const ContactKernels& kernels;
  SolveBatch batch{};
  std::span<const std::uint32_t> places{};  // of bodies in their batches
  WorkerPartition domains{};
  std::span<int> group_bounds{};                   // where there are several: for kMaxGroups
  void *blocks = nullptr, *cold_blocks = nullptr;  // of contacts
  float h = 0.0f;
  ContactSettings contact_settings{};
  JointSettings joint_settings{};
  ImpactSettings impact_settings{};
  ContactBodies contact_bodies{};
  JointBodies joint_bodies{};
  std::span<JointEdge> joint_edges{};    // the batch's joints
  std::span<std::uint8_t> ball_lanes{};  // 1 for those that may be solved side by side
  bool all_iterative = false;  // all are known to be swept: those of ball_lanes are begun in their lanes
  LaneStart lane_start{};  // of joints that are begun in lanes
  std::span<JointConstraint> joint_work{};
  std::span<JointOffsets> joint_offsets{};
  Articulations linkages{};
  ArticulationSolve articulation_solve{};
  std::span<std::span<double>> stop_rooms{};  // by worker, where a linkage has stops
  BundleSolve bundles{};
  std::span<std::uint32_t> joint_order{};  // places in the list of swept joints, by groups
  std::span<Group> joint_groups{};
  void* balls = nullptr;  // joints side by side: solver/articulation/ball_joint_simd.h
  std::span<const StiffenedBody> pulled{};
  std::span<JointIsland> joint_islands{};
  Motions motions{};
  std::span<MovedBody> moved{};               // the batch's bodies that constraints act on,
  void* motion_blocks = nullptr;              // the same for the kernels,
  std::span<Vec3> pushes{};                   // and how overlap turned them
  std::span<std::uint32_t> fast_spinning{};   // those of them that turn alone
  std::span<std::uint32_t> fast_spinning_starts{};  // by block of moved bodies: its first; one more
  FusedStage run_lines[2] = {};               // if bodies are moved run by run: of others, and of bundles
  std::size_t moved_in_contact = 0;           // of these, the first: contacts act on them
  const int* moved_bounds = nullptr;          // of the blocks, by domain: where contacts act on nearly all
  int recorded_blocks = 0;                 // the first: of these somebody asks what contacts gave the bodies
  std::span<std::uint32_t> free_bodies{};  // the others
  RestingTrees forest{};
  TreeSolve tree_solve{};
  std::span<RestingStructure> structures{};
  StructureSolve structure_solve{};
  RollingContacts rolling{};
  std::span<std::uint16_t> rolling_lanes{};   // by block of contacts: bits of those still to be taken along
  std::span<std::uint32_t> rolling_places{};  // by lane: which of those that roll it is
  FieldSolve fields{};
  bool is_smooth = false;  // free bodies are moved by the schemes of rigid/integrate/smooth_schemes.h
  SmoothMotion smooth{};
};

// A run of blocks of one colour.
struct Group {
  BatchContext* solve = nullptr;
  std::uint32_t first = 0;       // first block of contacts, or first place in the joint order
  std::uint32_t count = 0;       // blocks or joints
  bool serial = false;           // what is left over when the colours are used up: its members share bodies
  std::int32_t ball_block = -1;  // joints that are solved side by side: their first block
  const int* bounds = nullptr;   // of blocks of contacts, by domain
};

// By place in the batch: those joints that are begun and finished in their lanes, and have no work.
inline std::span<const std::uint8_t> prepared_in_simd(const BatchContext& solve) {
  return solve.all_iterative ? solve.ball_lanes : solve.linkages.simd;
}

}  // namespace gyre
