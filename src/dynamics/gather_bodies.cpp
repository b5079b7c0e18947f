#include "dynamics/gather_bodies.h"

#include "base/noinline.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// Bodies are sorted by how they rotate, because the kernels skip work that no body of a block needs.
constexpr std::uint8_t kExactRotation = 0, kNotGyroscopic = 1, kGyroscopic = 2, kRotationModes = 3;
std::uint8_t rotation_mode(const BodyMotionSolve& motion, std::uint32_t body) {
  if (needs_exact_rotation(motion.w.bodies, body, motion.motions.substep)) return kExactRotation;
  return motion.w.bodies.masses[body].isotropic != 0 ? kNotGyroscopic : kGyroscopic;
}

// True if the batch has grouped articulations, and only these and contacts act between the moves of bodies.
bool may_fuse(const BatchContext& batch) {
  const JointSolve& joints = batch.joints;
  return !batch.has_soft() && batch.couplings == nullptr && !joints.bundles.bundles.empty() && !batch.motion.is_smooth &&
         batch.scratch.contacts.impacts.empty() && joints.lists.swept.empty() &&
         joints.articulations.scalar.empty() && batch.motion.fields.blocks() == 0;
}

// Lists the bodies of articulation runs first, run by run. Marks them in `kinds`, by index in the batch.
GYRE_COLD void list_runs(BatchContext& batch, const RunLayout& runs, std::span<std::uint8_t> kinds,
                         std::uint8_t mark, Arena& arena) {
  const ArenaScope scope(arena);
  const std::size_t width = std::size_t(batch.kernels.width);
  for (const ArticulationRun& run : runs.of_articulations()) {
    const std::span<std::int32_t> bodies = arena.make<std::int32_t>(std::size_t(run.blocks) * width);
    list_run_bodies(batch.joints.bundles, run, bodies);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      batch.motion.moved[std::size_t(run.first_block) * width + i].body = bodies[i];
      if (bodies[i] != kNoBody) kinds[batch.local_index[std::size_t(bodies[i])]] = mark;
    }
  }
}

// Divides the bodies into constrained and free ones.
void part_bodies(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  const RigidWorld& w = batch.w;
  BodyMotionSolve& motion = batch.motion;
  const std::span<const std::uint32_t> bodies = batch.members.bodies;
  const int width = batch.kernels.width;
  RunLayout runs(may_fuse(batch) ? batch.joints.bundles : BundleSolve{}, bodies.size(), width, arena);
  const std::size_t led = std::size_t(runs.count_blocks() * width);
  motion.moved = arena.make<MovedBody>(led + bodies.size());
  motion.free_bodies = arena.make<std::uint32_t>(bodies.size());
  const std::span<int> bounds = arena.make<int>(std::size_t(batch.partition.count() + 1));
  const ArenaScope scope(arena);
  // The kind of a body is its group in the order: bodies in contact come first, by share and rotation mode.
  static_assert((kMaxShares + 1) * kRotationModes + 3 < 256, "kinds are bytes");
  const int shares = batch.partition.count();
  const std::uint8_t apart = std::uint8_t(shares * kRotationModes),
                     flies = std::uint8_t(apart + kRotationModes), stop_at_impact = std::uint8_t(flies + 1),
                     in_run = std::uint8_t(stop_at_impact + 1);
  const std::span<std::uint8_t> kinds = arena.make<std::uint8_t>(bodies.size());
  for (std::uint8_t& kind : kinds) kind = apart;
  const auto touch = [&](std::uint32_t body) {
    if (body != ColoringPair::kNone) kinds[body] = std::uint8_t(batch.partition.of(body) * kRotationModes);
  };
  for (const ColoringPair& pair : batch.scratch.contacts.pairs) touch(pair.a), touch(pair.b);
  list_runs(batch, runs, kinds, in_run, arena);
  for_blocks(tasks, int(bodies.size()), kBodiesPerBlock, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (kinds[i] == in_run) continue;
      const BodyFlags& flags = w.bodies.flags[bodies[i]];
      kinds[i] = flags.constraint_use != kNotConstrained ? std::uint8_t(kinds[i] + rotation_mode(motion, bodies[i]))
                 : !motion.is_smooth || !is_movable(flags) ? flies
                                                           : stop_at_impact;
    }
  });
  std::uint32_t starts[(kMaxShares + 1) * kRotationModes + 4] = {};
  for (const std::uint8_t kind : kinds) ++starts[kind + 1];
  for (std::size_t kind = 0; kind <= in_run; ++kind) starts[kind + 1] += starts[kind];
  const std::size_t moved = starts[flies], flying = starts[stop_at_impact] - moved;
  batch.moved_in_contact = led + starts[apart];
  if (shares > 1 && led == 0 && moved - batch.moved_in_contact <= moved / 8) {
    std::uint32_t firsts[kMaxShares];
    for (int i = 0; i < shares; ++i) firsts[i] = starts[i * kRotationModes];
    find_share_bounds(std::span(firsts).first(std::size_t(shares)), std::uint32_t(moved),
                      std::uint32_t(width), bounds.data());
    batch.moved_bounds = bounds.data();
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::size_t place = starts[kinds[i]]++;
    if (kinds[i] < flies) motion.moved[led + place].body = std::int32_t(bodies[i]);
    if (kinds[i] == flies) motion.free_bodies[place - moved] = bodies[i];
  }
  if (led > 0) {
    runs.add_blocks(count_blocks(int(moved), width));
    batch.fused_runs[0] = {&batch.joints, &motion, runs.of_others()};
    batch.fused_runs[1] = {&batch.joints, &motion, runs.of_articulations()};
  }
  motion.moved = motion.moved.first(led + moved);
  motion.free_bodies = motion.free_bodies.first(flying);
}

}  // namespace

void gather_bodies(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  RigidWorld& w = batch.w;
  BodyMotionSolve& motion = batch.motion;
  part_bodies(batch, arena, tasks);
  const std::size_t moved = motion.moved.size();
  motion.pushes = arena.make<Vec3>(moved);
  motion.fast_spinning = arena.make<std::uint32_t>(moved);
  std::size_t fast_spinning = 0;
  const auto describe = [&](int begin, int end, int) {
    bool any_spins = false;
    for (MovedBody& each : motion.moved.subspan(std::size_t(begin), std::size_t(end - begin))) {
      if (each.body == kNoBody) {
        each = MovedBody{};
        continue;
      }
      const std::uint32_t body = std::uint32_t(each.body);
      each = describe_motion(w.bodies, body, motion.motions, w.bodies.flags[body].constraint_use == kPoseRead);
      // A field may accelerate a light body within the step beyond the rotation that kernels compute.
      if (!w.field_rest.empty() && w.field_rest[body].acts != kNoFields) each.needs_exact_rotation = true;
      any_spins = any_spins || each.needs_exact_rotation;
    }
    return any_spins;
  };
  const auto either = [](bool a, bool b) { return a || b; };
  const std::size_t width = std::size_t(batch.kernels.width), blocks = (moved + width - 1) / width;
  if (reduce_blocks(tasks, int(moved), kBodiesPerBlock, false, describe, either)) {
    motion.fast_spinning_starts = arena.make<std::uint32_t>(blocks + 1);
    for (std::size_t i = 0; i < moved; ++i) {
      if (i % width == 0) motion.fast_spinning_starts[i / width] = std::uint32_t(fast_spinning);
      if (motion.moved[i].needs_exact_rotation)
        motion.fast_spinning[fast_spinning++] = std::uint32_t(motion.moved[i].body);
    }
    motion.fast_spinning_starts[blocks] = std::uint32_t(fast_spinning);
  }
  motion.fast_spinning = motion.fast_spinning.first(fast_spinning);
  motion.blocks = arena.make<std::byte>(blocks * batch.kernels.motion.block_bytes).data();
}

}  // namespace gyre
