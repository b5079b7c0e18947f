// Everything a world owns. What is simulation state is named once, in for_each_column: saving, loading, hashing and
// comparing are visitors of that one list, so a new array cannot be forgotten in one of them.
#pragma once

#include "base/arena/arena.h"
#include "base/profile/profile.h"
#include "rigid/rigid_step.h"
#include "rigid/solve/solve_step.h"
#include "rigid/store/rigid_world.h"
#include "rigid/time/toi_stepping.h"
#include "solver/contact/contact_block.h"
#include "task/task_system.h"
#include "world/command.h"
#include "world/state_fields.h"

#include <gyre/world.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace gyre {

// Sees every command just before it is carried out, and every step when it is done. The recorder is one.
class CommandLog {
 public:
  virtual ~CommandLog() = default;
  virtual void on_command(const Command& command) = 0;
  virtual void on_step_done(WorldState& state) = 0;
  // The state was replaced as a whole, by that of a snapshot.
  virtual void on_restored(WorldState& state) = 0;
};

// Called after every stage of a step with the stage's name: tools compare two worlds with it.
struct StageHook {
  void (*call)(void* context, const char* stage) = nullptr;
  void* context = nullptr;
};

constexpr std::size_t kNothingQueried = std::size_t(-1);

struct WorldState {
  // Simulation state.
  RigidWorld rigid;
  double time = 0.0;             // s
  std::uint64_t step_count = 0;

  // Everything below can be rebuilt, or is about this process and not about the simulated world.
  WorldDef def;
  std::unique_ptr<TaskSystem> tasks;
  const ContactKernels* kernels = nullptr;
  RecycleContacts recycle_contacts = nullptr;
  Arena arena;
  SolveScratch solve;
  ContinuousScratch continuous;
  ImpactScratch impacts;
  StageProfile profile;
  StageHook stage_hook;
  CommandLog* log = nullptr;
  Array<Problem> problems;
  Array<std::uint32_t> frozen;
  RigidEvents published_events;              // events of the last step; rigid.events collects those of the next
  Events events;                  // spans into `shown`
  bool stepping = false;
  bool walks = true;              // builds with GYRE_VALIDATE: after each stage all structures are walked
  std::uint16_t number = 0;       // of this world, in its ids
  // How many entries of rigid.shapes.changed queries have shown to the broad phase already; kNothingQueried when it may not even
  // have been built. Queries bring it up to date under the lock, since several threads may ask at once.
  std::atomic<std::size_t> queried_changes{kNothingQueried};
  std::mutex query_lock;
  std::mutex batch_lock;          // the workers answer one batch of queries at a time
  Array<std::uint32_t> changes_to_show;
  Array<std::uint64_t> change_keys, change_scratch;
  // Copies that bulk reading hands out; refreshed on demand.
  mutable std::vector<BodyId> read_ids;
  mutable std::vector<Pose> read_poses;
  mutable std::vector<Vec3> read_linear, read_angular;
};

// Columns that are read and set one record at a time.
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

// Columns that came after the first format: those of a world without such things are empty, and such a world has the hash and
// the snapshot that it always had.
template <class Column>
constexpr bool is_later_column = std::is_same_v<Column, Array<SurfaceRule>> || std::is_same_v<Column, Array<JointDetail>> ||
                                 std::is_same_v<Column, Array<PathPoint>> || std::is_same_v<Column, Array<FieldRecord>> ||
                                 std::is_same_v<Column, Array<MotionSettings>> || std::is_same_v<Column, Array<LastMove>> ||
                                 std::is_same_v<Column, Array<SolverSettings>>;

// Calls visit(name, column) for every column that is simulation state, in a fixed order. A column is an Array or an IsColumn of
// records that state_fields.h knows, an IdPool, the vector of geometry, or a single record.
template <class State, class Visitor>
void for_each_column(State& s, Visitor&& visit) {
  visit("time", s.time);
  visit("step_count", s.step_count);
  visit("settings", s.rigid.settings);
  visit("motion_settings", s.rigid.motion_settings);
  visit("solver", s.rigid.solver);
  visit("material_pairs", s.rigid.material_pairs);
  visit("surface_rules", s.rigid.surface_rules);
  visit("fields", s.rigid.fields);
  visit("body_ids", s.rigid.bodies.ids);
  visit("body_motion", s.rigid.bodies.motion);
  visit("body_last_moves", s.rigid.bodies.last_moves);
  visit("body_places", s.rigid.bodies.poses);
  visit("body_masses", s.rigid.bodies.masses);
  visit("body_forces", s.rigid.bodies.forces);
  visit("body_flags", s.rigid.bodies.flags);
  visit("body_sleep", s.rigid.bodies.sleep);
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
  visit("contacts", s.rigid.contacts.contacts);
  visit("manifolds", s.rigid.contacts.manifolds);
}

// A world with default state: no bodies; threads and kernels by the def.
std::unique_ptr<WorldState> make_world_state(const WorldDef& def);
// Why a def cannot be used; code none if it can.
Error check_world_def(const WorldDef& def);

// Why columns that came from outside cannot be a state: indices out of range, sets that disagree. Code none if they can.
Error check_columns(const RigidWorld& w);
// Derives everything that is not state from columns that hang together.
void derive_state(RigidWorld& w);
// Both in one: what loading ends with.
Error rebuild_derived(RigidWorld& w);

// 64-bit hash of all columns.
std::uint64_t hash_state(const WorldState& state);

// Lists a problem for the user.
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void report_problem(WorldState& state, ErrorCode code, BodyId body, const char* format, ...);

// One step: world/step.cpp.
void step_world(WorldState& state, float seconds);

}  // namespace gyre
