#include "world/world_state.h"

#include "base/float_mode.h"
#include "base/hash.h"
#include "collision/contact/contact_recycle.h"
#include "world/stages.h"

#include <atomic>
#include <bit>
#include <cstdarg>
#include <cstdio>
#include <span>

namespace gyre {

namespace {

std::uint16_t next_world_number() {
  static std::atomic<std::uint32_t> count{0};
  // Never 0: a null id belongs to no world.
  return std::uint16_t(1 + count.fetch_add(1, std::memory_order_relaxed) % 65535);
}

// Adds every field of every record to a hash, as little-endian words, so that padding and byte order never show.
class HashVisitor {
 public:
  template <class T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>)
  void operator()(const char*, const T& value) {
    add(value);
  }
  void operator()(const char*, const RigidSettings& settings) { add_record(settings); }
  template <class T>
  void operator()(const char*, const Array<T>& column) {
    if (is_later_column<Array<T>> && column.empty()) return;
    add_word(column.size());
    for (const T& record : column) add_record(record);
  }
  template <class T>
    requires IsColumn<T>
  void operator()(const char*, const T& column) {
    add_word(column.size());
    for (std::size_t i = 0; i < column.size(); ++i) add_record(column[i]);
  }
  void operator()(const char*, const IdPool& ids) {
    for (const std::uint32_t generation : ids.generations()) add_word(generation);
  }
  void operator()(const char*, const SoftStore& soft) {
    if (soft.entries.empty()) return;
    for (const std::uint32_t generation : soft.ids.generations()) add_word(generation);
    soft.for_each([&](const SoftEntry& entry) {
      const Particles& p = entry.body.particles;
      add_word(std::uint64_t(entry.kind) << 32 | std::uint64_t(p.count));
      for (const float mass : p.mass) add_record(mass);
      const auto add_array = [&](const auto& array) {
        add_word(array.size());
        for (const auto& record : array) add_record(record);
      };
      for_each_damage_array(entry, add_array);
      for_each_soft_array(entry, add_array);
      if (!entry.faces.empty()) add_array(entry.faces);
      if (!entry.points.empty()) add_array(entry.points);
    });
  }
  void operator()(const char*, const FluidStore& fluids) {
    if (fluids.entries.empty()) return;
    for (const std::uint32_t generation : fluids.ids.generations()) add_word(generation);
    fluids.for_each([&](const FluidEntry& entry) {
      add_word(std::uint64_t(entry.kind()) << 32 | std::uint64_t(entry.shape().count()));
      for_each_fluid_array(entry, [&](const auto& array) {
        add_word(array.size());
        for (const auto& record : array) add_record(record);
      });
      for_each_later_fluid_array(entry, [&](const auto& array) {
        for (const auto& record : array) add_record(record);
      });
    });
  }
  void operator()(const char*, const std::vector<AnyShape>& geometry) {
    for (const AnyShape& shape : geometry) add_word(hash_shape(shape));
  }
  std::uint64_t value() {
    update(used_);
    used_ = 0;
    return hasher_.value();
  }

 private:
  template <class T>
  void add_record(const T& record) {
    // Every field has at least one byte of its record, so this room suffices without a check for each field.
    static_assert(sizeof(T) + std::size_t(kGroup) <= std::size_t(kWords));
    if (used_ + int(sizeof(T)) > kWords) drain();
    int used = used_;
    for_each_field(record, [this, &used](const auto& value) { words_[used++] = to_word(value); });
    used_ = used;
  }
  template <class T>
  void add(const T& value) {
    if (used_ == kWords) drain();
    words_[used_++] = to_word(value);
  }
  template <class T>
  static std::uint64_t to_word(const T& value) {
    if constexpr (std::is_same_v<T, double>) {
      return __builtin_bit_cast(std::uint64_t, value);
    } else if constexpr (std::is_same_v<T, float>) {
      return __builtin_bit_cast(std::uint32_t, value);
    } else {
      return std::uint64_t(value);
    }
  }
  // Fields are hashed in groups. A word that is added directly is hashed before the fields of an incomplete group.
  void add_word(std::uint64_t word) {
    drain();
    hasher_.add(word);
  }
  void drain() {
    const int whole = used_ / kGroup * kGroup;
    update(whole);
    used_ -= whole;
    for (int i = 0; i < used_; ++i) words_[i] = words_[whole + i];
  }
  void update(int count) {
    if constexpr (std::endian::native == std::endian::little) {
      hasher_.add(std::as_bytes(std::span(words_, std::size_t(count))));  // the same bytes at once
    } else {
      for (int i = 0; i < count; ++i) hasher_.add(words_[i]);
    }
  }

  static std::uint64_t hash_shape(const AnyShape& shape);

  static constexpr int kGroup = 64, kWords = 2048;
  std::uint64_t words_[kWords];
  int used_ = 0;
  Hasher hasher_;
};

std::uint64_t HashVisitor::hash_shape(const AnyShape& shape) {
  Hasher hasher;
  hasher.add(std::uint64_t(shape.index()));
  if (const Geometry* cooked = std::get_if<Geometry>(&shape)) {
    hasher.add(cooked->content_hash());
    return hasher.value();
  }
  const Shape inner = make_shape(shape);
  for (const float value : {inner.radius, inner.extents.x, inner.extents.y, inner.extents.z, inner.offset}) {
    hasher.add(std::uint64_t(__builtin_bit_cast(std::uint32_t, value)));
  }
  return hasher.value();
}

}  // namespace

std::unique_ptr<WorldState> make_world_state(const WorldDef& def) {
  auto state = std::make_unique<WorldState>();
  state->def = def;
  state->number = next_world_number();
  state->tasks = def.host_tasks.run != nullptr ? std::make_unique<TaskSystem>(def.host_tasks)
                                               : std::make_unique<TaskSystem>(def.threads);
  state->kernels = &select_kernels(def.simd_width);
  state->gas_kernels = &select_gas_kernels(def.simd_width);
  state->recycle_contacts = select_recycling(def.simd_width);
  const char* timed[kStageCount + 1];
  for (int i = 0; i < kStageCount; ++i) timed[i] = kStageNames[i];
  timed[kWholeStep] = kWholeStepName;
  state->profile = StageProfile(timed, kCounterNames);
  RigidWorld& w = state->rigid;
  w.world_number = state->number;
  w.settings.gravity = def.gravity;
  w.settings.substeps = def.stepping.substeps;
  w.settings.sleeping = def.sleeping ? 1 : 0;
  if (const Stepping& by = def.stepping; by.solver != SolverKind::soft_step)
    w.solver.push_back({by.solver, by.solver_options});
  if (def.sleep_share != kSleepSpeedShare) w.sleep_settings.push_back({def.sleep_share});
  w.settings.friction_rule = def.friction_rule;
  w.settings.restitution_rule = def.restitution_rule;
  const MotionSettings motion{def.stepping.integrator, def.stepping.springs, def.stepping.time,
                              def.stepping.tolerance, def.stepping.max_impacts};
  if (!is_default(motion)) w.motion_settings.push_back(motion);
  w.broadphase = make_broadphase(def.stepping.broad_phase);
  return state;
}

void derive_state(RigidWorld& w) {
  const FloatMode mode;
  BodyStore& bodies = w.bodies;
  const std::size_t count = bodies.motion.size();
  bodies.inertia.resize(count);
  bodies.orientations.resize(count);
  bodies.shapes.resize(count);
  bodies.joints.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    bodies.orientations[i] = bodies.poses[i].orientation;
    refresh_inertia(bodies, i);
    bodies.shapes[i].clear();
  }
  bodies.awake_stale = true;
  refresh_awake(bodies);
  w.shapes.colliders.resize(w.shapes.ids.capacity());
  // The list of boxes that the broad phase has not seen is not saved. All boxes are listed. Of the pairs that it then
  // finds, only those have no contact that it would have found anyway.
  w.shapes.changed.clear();
  w.shapes.moved_shapes.clear();
  w.shapes.fat_box_horizon = 0.0f;
  w.shapes.ids.for_each_live([&](std::uint32_t shape) {
    refresh_collider(w.shapes, shape);
    bodies.shapes[w.shapes.bodies[shape]].push_back(shape_id(w, shape));
    w.shapes.changed.push_back(shape);
  });
  w.joints.blocked.clear();
  w.joints.ids.for_each_live([&](std::uint32_t slot) {
    const JointRecord& joint = w.joints.records[slot];
    if (joint.body_a != kNoBody) make_joints_of(bodies, std::uint32_t(joint.body_a)).push_back(slot);
    if (joint.body_b != kNoBody) make_joints_of(bodies, std::uint32_t(joint.body_b)).push_back(slot);
    if (!joint.collide_connected && joint.body_a != kNoBody && joint.body_b != kNoBody) {
      w.joints.blocked.find_or_insert(pair_key(std::uint32_t(joint.body_a), std::uint32_t(joint.body_b)), 0u)++;
    }
  });
  for (const IgnoredPair& pair : w.ignored_pairs)
    w.joints.blocked.find_or_insert(pair_key(pair.a, pair.b), 0u)++;
  rebuild_index(w.contacts);
  activate_all_constraints(w);
  w.broadphase_stale = true;
}

std::uint64_t hash_state(const WorldState& state) {
  const FloatMode mode;  // shapes are hashed in their form for collision, with unit normals
  HashVisitor visitor;
  for_each_column(state, visitor);
  return visitor.value();
}

void report_problem(WorldState& state, ErrorCode code, ProblemSubject subject, const char* format, ...) {
  constexpr std::size_t kMaxProblems = 256;  // bounds the memory of hosts that never read problems
  const bool is_kept = state.problems.size() < kMaxProblems;
  if (!is_kept && state.problem_hook.call == nullptr) return;
  Problem problem;
  problem.severity = code == ErrorCode::unstable ? Severity::warning : Severity::error;
  problem.code = code;
  problem.body = subject.body;
  problem.soft = subject.soft;
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(problem.message, sizeof problem.message, format, arguments);
  va_end(arguments);
  if (is_kept) state.problems.push_back(problem);
  if (state.problem_hook.call != nullptr) state.problem_hook.call(state.problem_hook.user, problem);
}

}  // namespace gyre
