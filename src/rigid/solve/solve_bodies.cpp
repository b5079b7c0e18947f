#include "rigid/solve/solve_bodies.h"

#include "base/cold.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// The kernels leave out what no body of a block needs: those that turn by another way lie apart.
constexpr std::uint8_t kTurnsAlone = 0, kNeverSwerves = 1, kSwerves = 2, kWaysToTurn = 3;
std::uint8_t way_to_turn(const Solve& solve, std::uint32_t body) {
  if (turns_alone(solve.w.bodies, body, solve.motions.substep)) return kTurnsAlone;
  return solve.w.bodies.masses[body].isotropic != 0 ? kNeverSwerves : kSwerves;
}

// Whether there are bundles, and nothing but they and contacts comes between the moves of bodies.
bool may_go_in_runs(const Solve& solve) {
  const BatchScratch& s = solve.scratch;
  return !solve.bundles.bundles.empty() && !solve.is_smooth && s.impacts.empty() && s.swept_joints.empty() &&
         solve.linkages.linkages.empty() && solve.fields.blocks() == 0;
}

// The bodies of runs of bundles come first, run by run. Marks them in `kinds`, by place in the batch.
GYRE_COLD void list_runs(Solve& solve, const BundleRuns& runs, std::span<std::uint8_t> kinds,
                         std::uint8_t mark, Arena& arena) {
  const ArenaScope scope(arena);
  const std::size_t width = std::size_t(solve.kernels.width);
  for (const BundleRun& run : runs.of_bundles()) {
    const std::span<std::int32_t> bodies = arena.make<std::int32_t>(std::size_t(run.blocks) * width);
    list_pushed(solve.bundles, run, bodies);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      solve.moved[std::size_t(run.first_block) * width + i].body = bodies[i];
      if (bodies[i] != kNoBody) kinds[solve.places[std::size_t(bodies[i])]] = mark;
    }
  }
}

// Lists the bodies that constraints act on, and the others.
void part_bodies(Solve& solve, Arena& arena, TaskSystem& tasks) {
  const RigidWorld& w = solve.w;
  const std::span<const std::uint32_t> bodies = solve.batch.bodies;
  const int width = solve.kernels.width;
  BundleRuns runs(may_go_in_runs(solve) ? solve.bundles : BundleSolve{}, bodies.size(), width, arena);
  const std::size_t led = std::size_t(runs.count_blocks() * width);
  solve.moved = arena.make<MovedBody>(led + bodies.size());
  solve.flying = arena.make<std::uint32_t>(bodies.size());
  const std::span<int> bounds = arena.make<int>(std::size_t(solve.domains.count() + 1));
  const ArenaScope scope(arena);
  // Where a body belongs: those in contact first, by domain and the way in which they turn.
  static_assert((kMostDomains + 1) * kWaysToTurn + 3 < 256, "kinds are bytes");
  const int domains = solve.domains.count();
  const std::uint8_t apart = std::uint8_t(domains * kWaysToTurn), flies = std::uint8_t(apart + kWaysToTurn),
                     stays = std::uint8_t(flies + 1), in_run = std::uint8_t(stays + 1);
  const std::span<std::uint8_t> kinds = arena.make<std::uint8_t>(bodies.size());
  for (std::uint8_t& kind : kinds) kind = apart;
  const auto touch = [&](std::uint32_t body) {
    if (body != ColoringPair::kNone) kinds[body] = std::uint8_t(solve.domains.of(body) * kWaysToTurn);
  };
  for (const ColoringPair& pair : solve.scratch.pairs) touch(pair.a), touch(pair.b);
  list_runs(solve, runs, kinds, in_run, arena);
  for_blocks(tasks, int(bodies.size()), kBodiesPerBlock, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (kinds[i] == in_run) continue;
      const BodyFlags& flags = w.bodies.flags[bodies[i]];
      kinds[i] = flags.touched != kUntouched ? std::uint8_t(kinds[i] + way_to_turn(solve, bodies[i]))
                 : !solve.is_smooth || !is_movable(flags) ? flies
                                                          : stays;
    }
  });
  std::uint32_t starts[(kMostDomains + 1) * kWaysToTurn + 4] = {};
  for (const std::uint8_t kind : kinds) ++starts[kind + 1];
  for (std::size_t kind = 0; kind <= in_run; ++kind) starts[kind + 1] += starts[kind];
  const std::size_t moved = starts[flies], flying = starts[stays] - moved;
  solve.moved_in_contact = led + starts[apart];
  if (domains > 1 && led == 0 && moved - solve.moved_in_contact <= moved / 8) {
    std::uint32_t firsts[kMostDomains];
    for (int i = 0; i < domains; ++i) firsts[i] = starts[i * kWaysToTurn];
    set_bounds(std::span(firsts).first(std::size_t(domains)), std::uint32_t(moved), std::uint32_t(width),
               bounds.data());
    solve.moved_bounds = bounds.data();
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::size_t place = starts[kinds[i]]++;
    if (kinds[i] < flies) solve.moved[led + place].body = std::int32_t(bodies[i]);
    if (kinds[i] == flies) solve.flying[place - moved] = bodies[i];
  }
  if (led > 0) {
    runs.add_blocks(count_blocks(int(moved), width));
    solve.run_lines[0] = {&solve, runs.of_others()};
    solve.run_lines[1] = {&solve, runs.of_bundles()};
  }
  solve.moved = solve.moved.first(led + moved);
  solve.flying = solve.flying.first(flying);
}

}  // namespace

void gather_motion(Solve& solve, Arena& arena, TaskSystem& tasks) {
  RigidWorld& w = solve.w;
  part_bodies(solve, arena, tasks);
  const std::size_t moved = solve.moved.size();
  solve.pushes = arena.make<Vec3>(moved);
  solve.spinners = arena.make<std::uint32_t>(moved);
  std::size_t spinners = 0;
  const auto describe = [&](int begin, int end, int) {
    bool any_spins = false;
    for (MovedBody& each : solve.moved.subspan(std::size_t(begin), std::size_t(end - begin))) {
      if (each.body == kNoBody) {
        each = MovedBody{};
        continue;
      }
      const std::uint32_t body = std::uint32_t(each.body);
      each = describe_motion(w.bodies, body, solve.motions, w.bodies.flags[body].touched == kPlaceShown);
      // A field may spin a light body up within the step, beyond what the kernels turn.
      if (!w.field_rest.empty() && w.field_rest[body].acts != kNoFields) each.turns_alone = true;
      any_spins = any_spins || each.turns_alone;
    }
    return any_spins;
  };
  const auto either = [](bool a, bool b) { return a || b; };
  const std::size_t width = std::size_t(solve.kernels.width), blocks = (moved + width - 1) / width;
  if (reduce_blocks(tasks, int(moved), kBodiesPerBlock, false, describe, either)) {
    solve.spinner_starts = arena.make<std::uint32_t>(blocks + 1);
    for (std::size_t i = 0; i < moved; ++i) {
      if (i % width == 0) solve.spinner_starts[i / width] = std::uint32_t(spinners);
      if (solve.moved[i].turns_alone) solve.spinners[spinners++] = std::uint32_t(solve.moved[i].body);
    }
    solve.spinner_starts[blocks] = std::uint32_t(spinners);
  }
  solve.spinners = solve.spinners.first(spinners);
  solve.motion_blocks = arena.make<std::byte>(blocks * solve.kernels.motion.block_bytes).data();
}

}  // namespace gyre
