// WorldBatch (gyre/batch.h): copies of one world, and their steps over the workers of a pool.
//
// In: a world, rows of actions. Out: rows of observations. One worker steps a whole world at a time, so neither the number of workers nor
// the order in which they take worlds changes a bit.
#include "batch/batch_channels.h"

#include "io/snapshot/state_copy.h"
#include "task/task_system.h"
#include "world/world_access.h"

#include <gyre/batch.h>

#include <atomic>
#include <cmath>

namespace gyre {

namespace {

constexpr int kMaxBatchWorlds = 60000;
constexpr std::size_t kMaxDraws = 64;

struct BatchWorld {
  explicit BatchWorld(World made) : world(std::move(made)), number(state_of(world).number) {}

  World world;
  std::uint16_t number;   // in ids
  std::uint64_t run = 0;  // resets so far
  std::vector<ContactPoint> points;
  bool refused = false;
};

// The events that the next step of the start would report have ids of that world.
void forget_events(WorldState& state) {
  RigidEvents& events = state.rigid.events;
  events.begins.clear(), events.ends.clear(), events.hits.clear();
  events.sensors.clear(), events.broken.clear(), events.sleep_changes.clear();
  state.soft.events.clear();
}

Error wrong_size(const char* what, std::size_t found, std::size_t expected) {
  return make_error(ErrorCode::invalid_argument, "batch: %s has %zu elements, expected %zu", what, found,
                    expected);
}

}  // namespace

struct WorldBatch::Worlds {
  explicit Worlds(int threads) : tasks(threads) {}

  // Calls fn(world) for each world, over the workers.
  template <class Fn>
  void for_each(Fn&& fn) const {
    std::atomic<std::size_t> next{0};
    tasks.run_claiming([&](int) {
      for (std::size_t i = next.fetch_add(1, std::memory_order_relaxed); i < worlds.size();
           i = next.fetch_add(1, std::memory_order_relaxed)) {
        fn(i);
      }
    });
  }

  void observe(std::size_t i, float* out) const {
    BatchWorld& in = *worlds[i];
    for (const BatchReading& reading : observations)
      out = read_channel(in.world, in.number, reading, seconds, in.points, out);
  }
  bool act(BatchWorld& in, const float* values, bool first) const {
    bool done = true;
    for (const BatchAction& action : actions) {
      done = apply_action(in.world, in.number, action, values, first) && done;
      values += width_of(action);
    }
    return done;
  }
  void restart(std::size_t i) {
    BatchWorld& in = *worlds[i];
    start.restore(state_of(in.world));
    forget_events(state_of(in.world));
    ++in.run;
    in.refused = false;
    for (std::size_t k = 0; k < draws.size(); ++k) {
      if (!apply_draw(in.world, in.number, draws[k], draw_values(draws[k], seed, i, in.run, k)))
        in.refused = true;
    }
  }
  // The first world that refused a command.
  Error refusal() const {
    for (std::size_t i = 0; i < worlds.size(); ++i) {
      if (!worlds[i]->refused) continue;
      const std::span<const Problem> problems = worlds[i]->world.problems();
      return make_error(problems.empty() ? ErrorCode::invalid_argument : problems.back().code,
                        "world %zu: %.200s", i, problems.empty() ? "refused" : problems.back().message);
    }
    return {};
  }

  StateCopy start;
  std::vector<BodyId> bodies;  // of the start
  std::vector<std::unique_ptr<BatchWorld>> worlds;
  std::vector<BatchReading> observations;
  std::vector<BatchAction> actions;
  std::vector<BatchDraw> draws;
  std::uint64_t seed = 0;
  std::size_t observation_width = 0, action_width = 0;
  float seconds = 0.0f;  // of the last step
  mutable TaskSystem tasks;
};

WorldBatch::WorldBatch(std::unique_ptr<Worlds> worlds) : worlds_(std::move(worlds)) {}
WorldBatch::~WorldBatch() = default;
WorldBatch::WorldBatch(WorldBatch&&) noexcept = default;
WorldBatch& WorldBatch::operator=(WorldBatch&&) noexcept = default;

Result<WorldBatch> WorldBatch::create(const World& start, int worlds, int threads) {
  if (worlds < 1 || worlds > kMaxBatchWorlds || threads < 0 || threads > 1024) {
    return make_error(
        ErrorCode::invalid_argument,
        "batch: found %d worlds and %d threads, expected 1 to 60,000 worlds and 0 to 1,024 threads", worlds,
        threads);
  }
  if (state_of(start).stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  auto made = std::make_unique<Worlds>(threads);
  made->start.save(state_of(start));
  const std::span<const BodyId> bodies = start.bodies().ids;
  made->bodies.assign(bodies.begin(), bodies.end());
  WorldDef def = start.def();
  def.threads = 1;
  def.host_tasks = {};
  made->worlds.reserve(std::size_t(worlds));
  for (int i = 0; i < worlds; ++i) {
    Result<World> world = World::create(def);
    if (!world) return world.error();
    made->worlds.push_back(std::make_unique<BatchWorld>(*std::move(world)));
  }
  made->for_each([&](std::size_t i) { made->restart(i); });
  for (const std::unique_ptr<BatchWorld>& in : made->worlds) in->run = 0;
  return WorldBatch(std::move(made));
}

Error WorldBatch::set_observations(std::span<const BatchReading> readings) {
  std::size_t width = 0;
  const BatchWorld& first = *worlds_->worlds.front();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (const Error e = check_reading(readings[i], i, first.world, first.number)) return e;
    width += std::size_t(width_of(readings[i]));
  }
  worlds_->observations.assign(readings.begin(), readings.end());
  worlds_->observation_width = width;
  return {};
}

Error WorldBatch::set_actions(std::span<const BatchAction> actions) {
  std::size_t width = 0;
  const BatchWorld& first = *worlds_->worlds.front();
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (const Error e = check_action(actions[i], i, first.world, first.number)) return e;
    width += std::size_t(width_of(actions[i]));
  }
  worlds_->actions.assign(actions.begin(), actions.end());
  worlds_->action_width = width;
  return {};
}

Error WorldBatch::set_draws(std::span<const BatchDraw> draws, std::uint64_t seed) {
  if (draws.size() > kMaxDraws)
    return make_error(ErrorCode::invalid_argument, "batch: found %zu draws, expected at most 64",
                      draws.size());
  const BatchWorld& first = *worlds_->worlds.front();
  for (std::size_t i = 0; i < draws.size(); ++i) {
    if (const Error e = check_draw(draws[i], i, first.world, first.number)) return e;
  }
  worlds_->draws.assign(draws.begin(), draws.end());
  worlds_->seed = seed;
  for (const std::unique_ptr<BatchWorld>& in : worlds_->worlds) in->run = 0;
  return reset();
}

std::size_t WorldBatch::size() const { return worlds_->worlds.size(); }
std::size_t WorldBatch::body_count() const { return worlds_->bodies.size(); }
std::size_t WorldBatch::observation_width() const { return worlds_->observation_width; }
std::size_t WorldBatch::action_width() const { return worlds_->action_width; }

Error WorldBatch::step(float seconds, int steps, std::span<const float> actions,
                       std::span<float> observations) {
  if (steps < 1 || !(seconds > 0.0f && seconds <= 1.0f)) {
    return make_error(ErrorCode::invalid_argument,
                      "batch: expected at least one step, and seconds above 0 and at most 1");
  }
  const Worlds& all = *worlds_;
  if (!actions.empty() && actions.size() != size() * all.action_width)
    return wrong_size("actions", actions.size(), size() * all.action_width);
  if (!observations.empty() && observations.size() != size() * all.observation_width)
    return wrong_size("observations", observations.size(), size() * all.observation_width);
  worlds_->seconds = seconds;
  all.for_each([&](std::size_t i) {
    BatchWorld& in = *all.worlds[i];
    in.refused = false;
    for (int step = 0; step < steps && !in.refused; ++step) {
      if (!actions.empty() && !all.act(in, actions.data() + i * all.action_width, step == 0))
        in.refused = true;
      if (!in.refused && !in.world.step(seconds)) in.refused = true;
    }
    if (!observations.empty()) all.observe(i, observations.data() + i * all.observation_width);
  });
  return all.refusal();
}

Error WorldBatch::reset(std::span<const std::uint8_t> which) {
  if (!which.empty() && which.size() != size())
    return wrong_size("the choice of worlds", which.size(), size());
  worlds_->for_each([&](std::size_t i) {
    worlds_->worlds[i]->refused = false;
    if (which.empty() || which[i] != 0) worlds_->restart(i);
  });
  return worlds_->refusal();
}

Error WorldBatch::observe(std::span<float> out) const {
  if (out.size() != size() * observation_width())
    return wrong_size("observations", out.size(), size() * observation_width());
  worlds_->for_each([&](std::size_t i) { worlds_->observe(i, out.data() + i * observation_width()); });
  return {};
}

Error WorldBatch::columns(std::span<Pose> poses, std::span<Vec3> linear_velocities,
                          std::span<Vec3> angular_velocities) const {
  const std::size_t bodies = body_count(), expected = size() * bodies;
  for (const std::size_t found : {poses.size(), linear_velocities.size(), angular_velocities.size()}) {
    if (found != 0 && found != expected) return wrong_size("a column", found, expected);
  }
  worlds_->for_each([&](std::size_t i) {
    const BatchWorld& in = *worlds_->worlds[i];
    for (std::size_t b = 0; b < bodies; ++b) {
      const BodyId id = with_number(worlds_->bodies[b], in.number);
      if (!poses.empty()) poses[i * bodies + b] = in.world.pose(id);
      if (!linear_velocities.empty()) linear_velocities[i * bodies + b] = in.world.linear_velocity(id);
      if (!angular_velocities.empty()) angular_velocities[i * bodies + b] = in.world.angular_velocity(id);
    }
  });
  return {};
}

Error WorldBatch::hashes(std::span<std::uint64_t> out) const {
  if (out.size() != size()) return wrong_size("hashes", out.size(), size());
  worlds_->for_each([&](std::size_t i) { out[i] = worlds_->worlds[i]->world.hash(); });
  return {};
}

Vec3 WorldBatch::drawn(std::size_t world, std::size_t draw) const {
  if (world >= size() || draw >= worlds_->draws.size()) return {};
  return draw_values(worlds_->draws[draw], worlds_->seed, world, worlds_->worlds[world]->run, draw);
}

World& WorldBatch::world(std::size_t index) { return worlds_->worlds[index]->world; }
const World& WorldBatch::world(std::size_t index) const { return worlds_->worlds[index]->world; }
BodyId WorldBatch::body(std::size_t index, BodyId body) const {
  return with_number(body, worlds_->worlds[index]->number);
}
JointId WorldBatch::joint(std::size_t index, JointId joint) const {
  return with_number(joint, worlds_->worlds[index]->number);
}

}  // namespace gyre
