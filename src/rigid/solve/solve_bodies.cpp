#include "rigid/solve/solve_bodies.h"

#include "base/noinline.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// The kernels leave out what no body of a block needs: those that turn by another way lie apart.
constexpr std::uint8_t kExactRotation = 0, kNotGyroscopic = 1, kGyroscopic = 2, kRotationModes = 3;
std::uint8_t rotation_mode(const BatchContext& solve, std::uint32_t body) {
  if (needs_exact_rotation(solve.w.bodies, body, solve.motions.substep)) return kExactRotation;
  return solve.w.bodies.masses[body].isotropic != 0 ? kNotGyroscopic : kGyroscopic;
}

// Whether there are bundles, and nothing but they and contacts comes between the moves of bodies.
bool may_go_in_runs(const BatchContext& solve) {
  const BatchScratch& s = solve.scratch;
  return !solve.bundles.bundles.empty() && !solve.is_smooth && s.impacts.empty() && s.swept_joints.empty() &&
         solve.linkages.linkages.empty() && solve.fields.blocks() == 0;
}

// The bodies of runs of bundles come first, run by run. Marks them in `kinds`, by place in the batch.
GYRE_COLD void list_runs(BatchContext& solve, const FusedStages& runs, std::span<std::uint8_t> kinds,
                         std::uint8_t mark, Arena& arena) {
  const ArenaScope scope(arena);
  const std::size_t width = std::size_t(solve.kernels.width);
  for (const FusedRange& run : runs.of_bundles()) {
    const std::span<std::int32_t> bodies = arena.make<std::int32_t>(std::size_t(run.blocks) * width);
    list_pushed(solve.bundles, run, bodies);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      solve.moved[std::size_t(run.first_block) * width + i].body = bodies[i];
      if (bodies[i] != kNoBody) kinds[solve.places[std::size_t(bodies[i])]] = mark;
    }
  }
}

// Lists the bodies that constraints act on, and the others.
void part_bodies(BatchContext& solve, Arena& arena, TaskSystem& tasks) {
  const RigidWorld& w = solve.w;
  const std::span<const std::uint32_t> bodies = solve.batch.bodies;
  const int width = solve.kernels.width;
  FusedStages runs(may_go_in_runs(solve) ? solve.bundles : BundleSolve{}, bodies.size(), width, arena);
  const std::size_t led = std::size_t(runs.count_blocks() * width);
  solve.moved = arena.make<MovedBody>(led + bodies.size());
  solve.free_bodies = arena.make<std::uint32_t>(bodies.size());
  const std::span<int> bounds = arena.make<int>(std::size_t(solve.domains.count() + 1));
  const ArenaScope scope(arena);
  // Where a body belongs: those in contact first, by domain and the way in which they turn.
  static_assert((kMaxPartitions + 1) * kRotationModes + 3 < 256, "kinds are bytes");
  const int domains = solve.domains.count();
  const std::uint8_t apart = std::uint8_t(domains * kRotationModes),
                     flies = std::uint8_t(apart + kRotationModes), stop_at_impact = std::uint8_t(flies + 1),
                     in_run = std::uint8_t(stop_at_impact + 1);
  const std::span<std::uint8_t> kinds = arena.make<std::uint8_t>(bodies.size());
  for (std::uint8_t& kind : kinds) kind = apart;
  const auto touch = [&](std::uint32_t body) {
    if (body != ColoringPair::kNone) kinds[body] = std::uint8_t(solve.domains.of(body) * kRotationModes);
  };
  for (const ColoringPair& pair : solve.scratch.pairs) touch(pair.a), touch(pair.b);
  list_runs(solve, runs, kinds, in_run, arena);
  for_blocks(tasks, int(bodies.size()), kBodiesPerBlock, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (kinds[i] == in_run) continue;
      const BodyFlags& flags = w.bodies.flags[bodies[i]];
      kinds[i] = flags.constraint_use != kNotConstrained
                     ? std::uint8_t(kinds[i] + rotation_mode(solve, bodies[i]))
                 : !solve.is_smooth || !is_movable(flags) ? flies
                                                          : stop_at_impact;
    }
  });
  std::uint32_t starts[(kMaxPartitions + 1) * kRotationModes + 4] = {};
  for (const std::uint8_t kind : kinds) ++starts[kind + 1];
  for (std::size_t kind = 0; kind <= in_run; ++kind) starts[kind + 1] += starts[kind];
  const std::size_t moved = starts[flies], flying = starts[stop_at_impact] - moved;
  solve.moved_in_contact = led + starts[apart];
  if (domains > 1 && led == 0 && moved - solve.moved_in_contact <= moved / 8) {
    std::uint32_t firsts[kMaxPartitions];
    for (int i = 0; i < domains; ++i) firsts[i] = starts[i * kRotationModes];
    set_partition_bounds(std::span(firsts).first(std::size_t(domains)), std::uint32_t(moved),
                         std::uint32_t(width), bounds.data());
    solve.moved_bounds = bounds.data();
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::size_t place = starts[kinds[i]]++;
    if (kinds[i] < flies) solve.moved[led + place].body = std::int32_t(bodies[i]);
    if (kinds[i] == flies) solve.free_bodies[place - moved] = bodies[i];
  }
  if (led > 0) {
    runs.add_blocks(count_blocks(int(moved), width));
    solve.run_lines[0] = {&solve, runs.of_others()};
    solve.run_lines[1] = {&solve, runs.of_bundles()};
  }
  solve.moved = solve.moved.first(led + moved);
  solve.free_bodies = solve.free_bodies.first(flying);
}

}  // namespace

void gather_motion(BatchContext& solve, Arena& arena, TaskSystem& tasks) {
  RigidWorld& w = solve.w;
  part_bodies(solve, arena, tasks);
  const std::size_t moved = solve.moved.size();
  solve.pushes = arena.make<Vec3>(moved);
  solve.fast_spinning = arena.make<std::uint32_t>(moved);
  std::size_t fast_spinning = 0;
  const auto describe = [&](int begin, int end, int) {
    bool any_spins = false;
    for (MovedBody& each : solve.moved.subspan(std::size_t(begin), std::size_t(end - begin))) {
      if (each.body == kNoBody) {
        each = MovedBody{};
        continue;
      }
      const std::uint32_t body = std::uint32_t(each.body);
      each = describe_motion(w.bodies, body, solve.motions, w.bodies.flags[body].constraint_use == kPoseRead);
      // A field may spin a light body up within the step, beyond what the kernels turn.
      if (!w.field_rest.empty() && w.field_rest[body].acts != kNoFields) each.needs_exact_rotation = true;
      any_spins = any_spins || each.needs_exact_rotation;
    }
    return any_spins;
  };
  const auto either = [](bool a, bool b) { return a || b; };
  const std::size_t width = std::size_t(solve.kernels.width), blocks = (moved + width - 1) / width;
  if (reduce_blocks(tasks, int(moved), kBodiesPerBlock, false, describe, either)) {
    solve.fast_spinning_starts = arena.make<std::uint32_t>(blocks + 1);
    for (std::size_t i = 0; i < moved; ++i) {
      if (i % width == 0) solve.fast_spinning_starts[i / width] = std::uint32_t(fast_spinning);
      if (solve.moved[i].needs_exact_rotation)
        solve.fast_spinning[fast_spinning++] = std::uint32_t(solve.moved[i].body);
    }
    solve.fast_spinning_starts[blocks] = std::uint32_t(fast_spinning);
  }
  solve.fast_spinning = solve.fast_spinning.first(fast_spinning);
  solve.motion_blocks = arena.make<std::byte>(blocks * solve.kernels.motion.block_bytes).data();
}

}  // namespace gyre
