// Everything that a world owns. for_each_column names all simulation state once; saving, loading, hashing and
// comparison are visitors of this list, so none of them can miss a new array.
#pragma once

#include "base/arena/arena.h"
#include "base/profile/profile.h"
#include "dynamics/fluid/fluid_step.h"
#include "dynamics/solve_step.h"
#include "rigid/rigid_step.h"
#include "rigid/store/rigid_world.h"
#include "rigid/time/toi_stepping.h"
#include "soft/query/soft_query.h"
#include "soft/store/soft_damage.h"
#include "soft/store/soft_store.h"
#include "solver/kernels/solver_kernels.h"
#include "task/task_system.h"
#include "world/command.h"
#include "world/state_fields.h"

#include <gyre/world.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace gyre {

// Receives every command just before it is executed, and every step when it is done. The recorder is one.
class CommandLog {
 public:
  virtual ~CommandLog() = default;
  virtual void on_command(const Command& command) = 0;
  virtual void on_step_done(WorldState& state) = 0;
  // The state was replaced by that of a snapshot.
  virtual void on_restored(WorldState& state) = 0;
};

// Called after every stage of a step with the name of the stage. Tools compare two worlds with it.
struct StageHook {
  void (*call)(void* context, const char* stage) = nullptr;
  void* context = nullptr;
};

constexpr std::size_t kNothingQueried = std::size_t(-1);

// A result of World::bodies(). After a change, the first reading thread makes it (under WorldState::query_lock); all
// threads read it. Its spans are valid until the next change.
struct BodyCopy {
  std::vector<BodyId> ids;
  std::vector<Pose> poses;
  std::vector<Vec3> linear_velocities, angular_velocities;
  std::atomic<std::uint64_t> made_at{~std::uint64_t(0)};  // WorldState::changes at that time
};

struct WorldState {
  // Simulation state.
  RigidWorld rigid;
  SoftStore soft;
  FluidStore fluids;
  double time = 0.0;             // s
  std::uint64_t step_count = 0;

  // Everything below can be derived, or belongs to this process and not to the simulated world.
  WorldDef def;
  std::unique_ptr<TaskSystem> tasks;
  const SolverKernels* kernels = nullptr;
  RecycleContacts recycle_contacts = nullptr;
  Arena arena;
  SolveScratch solve;
  ContinuousScratch continuous;
  ImpactScratch impacts;
  const GasKernels* gas_kernels = nullptr;
  std::vector<FluidScratch> fluid_scratch;  // by slot
  SoftStore soft_before;  // before a step that may be tried again
  StageProfile profile;
  StageHook stage_hook;
  CommandLog* log = nullptr;
  Array<Problem> problems;
  ProblemHook problem_hook;
  Array<std::uint32_t> frozen;
  Array<std::uint32_t> quarantined_soft;  // slots, in the last step
  RigidEvents published_events;  // events of the last step; rigid.events collects those of the next
  SoftEvents published_soft_events;  // soft.events collects those of the next step
  Array<FluidTouch> published_fluid_touches;  // fluids.events collects those of commands for the next step
  Events events;                 // spans of all
  Array<std::uint8_t> soft_touch_mark;  // by shape; 0 but while shapes are listed
  Array<SoftTouch> soft_touching;
  Array<std::uint8_t> soft_inverted;
  Array<SoftSplit> soft_splits;
  bool stepping = false;
  bool validates = true;          // builds with GYRE_VALIDATE: state validation after each stage
  std::uint16_t number = 0;       // of this world, in its ids
  // The number of entries of rigid.shapes.changed that queries have given to the broad phase; kNothingQueried if it
  // may not be built yet. Queries update it under the lock, since several threads may query at once.
  std::atomic<std::size_t> queried_changes{kNothingQueried};
  std::mutex query_lock;
  // Boxes of soft matter for queries, by slot; made for the state of WorldState::changes, under the lock.
  std::vector<SoftBoxes> soft_boxes;
  Arena soft_box_memory;
  std::atomic<std::uint64_t> soft_boxes_made_at{~std::uint64_t(0)};
  std::mutex batch_lock;          // the workers answer one batch of queries at a time
  Array<std::uint32_t> changes_to_show;
  Array<std::uint64_t> change_keys, change_scratch;
  // Counts the changes of the state, so that a copy is known to be current. Every change of bodies must call
  // note_change.
  std::uint64_t changes = 0;
  // The copies for bulk reading: of all bodies, and of awake bodies.
  BodyCopy all_bodies, awake_bodies;
};

inline void note_change(WorldState& state) { ++state.changes; }

// Columns whose records are read and set one at a time.
template <class T>
constexpr bool is_column = false;
template <class T>
constexpr bool is_column<InternedColumn<T>> = true;
template <class T, std::size_t N>
constexpr bool is_column<PagedArray<T, N>> = true;
template <class T>
concept IsColumn = is_column<T>;
template <IsColumn T>
using RecordOf = std::remove_cvref_t<decltype(std::declval<const T&>()[std::size_t{0}])>;

// Columns that were added after the first format. They are empty in worlds that do not need them; such a world has
// the hash and the snapshot of older versions.
template <class Column>
constexpr bool is_later_column = std::is_same_v<Column, Array<SurfaceRule>> || std::is_same_v<Column, Array<JointDetail>> ||
                                 std::is_same_v<Column, Array<PathPoint>> || std::is_same_v<Column, Array<FieldRecord>> ||
                                 std::is_same_v<Column, Array<MotionSettings>> || std::is_same_v<Column, Array<LastMove>> ||
                                 std::is_same_v<Column, Array<SolverSettings>> || std::is_same_v<Column, SoftStore> ||
                                 std::is_same_v<Column, FluidStore> || std::is_same_v<Column, Array<SleepSettings>> ||
                                 std::is_same_v<Column, Array<BodySleepSpeed>> || std::is_same_v<Column, Array<IgnoredPair>> ||
                                 std::is_same_v<Column, Array<CouplingRecord>> || std::is_same_v<Column, Array<FieldGrid>> ||
                                 std::is_same_v<Column, Array<FieldVector>>;

// Calls visit(name, column) for every state column, in a fixed order. A column is an Array or an IsColumn of records
// that state_fields.h knows, an IdPool, the vector of geometry, or a single record.
template <class State, class Visitor>
void for_each_column(State& s, Visitor&& visit) {
  visit("time", s.time);
  visit("step_count", s.step_count);
  visit("settings", s.rigid.settings);
  visit("motion_settings", s.rigid.motion_settings);
  visit("solver", s.rigid.solver);
  visit("sleep_settings", s.rigid.sleep_settings);
  visit("material_pairs", s.rigid.material_pairs);
  visit("ignored_pairs", s.rigid.ignored_pairs);
  visit("surface_rules", s.rigid.surface_rules);
  visit("fields", s.rigid.fields);
  visit("field_grids", s.rigid.field_grids);
  visit("field_vectors", s.rigid.field_vectors);
  visit("body_ids", s.rigid.bodies.ids);
  visit("body_motion", s.rigid.bodies.motion);
  visit("body_last_moves", s.rigid.bodies.last_moves);
  visit("body_places", s.rigid.bodies.poses);
  visit("body_masses", s.rigid.bodies.masses);
  visit("body_forces", s.rigid.bodies.forces);
  visit("body_flags", s.rigid.bodies.flags);
  visit("body_sleep", s.rigid.bodies.sleep);
  visit("body_sleep_speeds", s.rigid.bodies.sleep_speeds);
  visit("body_overrides", s.rigid.bodies.overrides);
  visit("body_user_data", s.rigid.bodies.user_data);
  visit("shape_ids", s.rigid.shapes.ids);
  visit("shape_bodies", s.rigid.shapes.bodies);
  visit("shape_places", s.rigid.shapes.body_from_shape);
  visit("shape_proxies", s.rigid.shapes.proxies);
  visit("shape_materials", s.rigid.shapes.materials);
  visit("shape_geometry", s.rigid.shapes.geometry);
  visit("shape_density", s.rigid.shapes.density);
  visit("shape_user_data", s.rigid.shapes.user_data);
  visit("joint_ids", s.rigid.joints.ids);
  visit("joints", s.rigid.joints.records);
  visit("joint_details", s.rigid.joints.details);
  visit("path_points", s.rigid.joints.path_points);
  visit("couplings", s.rigid.couplings);
  visit("contacts", s.rigid.contacts.contacts);
  visit("manifolds", s.rigid.contacts.manifolds);
  visit("soft", s.soft);
  visit("fluids", s.fluids);
}

// A world with default state: no bodies; threads and kernels as in the def.
std::unique_ptr<WorldState> make_world_state(const WorldDef& def);
// Why a def is invalid; code none if it is valid.
Error check_world_def(const WorldDef& def);

// Why loaded columns cannot be a state: invalid indices, inconsistent sets. Code none if they can.
Error check_columns(const RigidWorld& w);
// Derives all data that is not state from consistent columns.
void derive_state(RigidWorld& w);
// Checks what refers from soft matter to bodies and shapes.
Error check_soft_columns(const RigidWorld& w, const SoftStore& soft);
// Checks fluids and what they refer to.
Error check_fluid_columns(const RigidWorld& w, const FluidStore& fluids);
// Checks and derives: the last step of loading.
Error rebuild_derived(RigidWorld& w);

// 64-bit hash of all columns.
std::uint64_t hash_state(const WorldState& state);

// The subject of a problem: a body, soft matter, or neither.
struct ProblemSubject {
  BodyId body{};
  SoftId soft{};
  ProblemSubject() = default;
  ProblemSubject(BodyId of) : body(of) {}
  ProblemSubject(SoftId of) : soft(of) {}
};

// Adds a problem for the user.
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void report_problem(WorldState& state, ErrorCode code, ProblemSubject subject, const char* format, ...);

// One step: world/step.cpp.
void step_world(WorldState& state, float seconds);

}  // namespace gyre
