// Runs a random world in every way that must give the same bits, and compares each run with that of the reference after every
// step: state, events, contacts and readings. Where a run differs, the failure names the first stage, column and row.
//
// A Driver makes a world from a number and gives it commands. All choices follow from the number, the step and what the world holds, so a copy
// of the driver goes on with a copy of the world.
#pragma once

#include "determinism/scenes.h"

#include "base/hash.h"
#include "memory_sink.h"

#include <gtest/gtest.h>

#include <string>

namespace gyre::random_run {

using scenes::Random;

// -------------------------------------------------------------------------------------------------- what can be seen

class Digest {
 public:
  void add(float v) { hasher_.add(std::uint64_t(__builtin_bit_cast(std::uint32_t, v))); }
  void add(double v) { hasher_.add(__builtin_bit_cast(std::uint64_t, v)); }
  void add(Vec3 v) { add(v.x), add(v.y), add(v.z); }
  void add(DVec3 v) { add(v.x), add(v.y), add(v.z); }
  void add(Quat q) { add(q.x), add(q.y), add(q.z), add(q.w); }
  void add(std::size_t v) { hasher_.add(v); }
  // The world's own number differs from world to world.
  template <class Tag>
  void add(Id<Tag> id) {
    hasher_.add(std::uint64_t(id.index) << 16 | id.generation);
  }
  std::uint64_t value() const { return hasher_.value(); }

 private:
  Hasher hasher_;
};

inline std::uint64_t digest_of_events(const Events& events) {
  Digest digest;
  for (const ContactBegin& e : events.begins)
    digest.add(e.shape_a), digest.add(e.shape_b), digest.add(e.body_b);
  digest.add(events.begins.size());
  for (const ContactEnd& e : events.ends) digest.add(e.shape_a), digest.add(e.shape_b);
  digest.add(events.ends.size());
  for (const ContactHit& e : events.hits)
    digest.add(e.shape_a), digest.add(e.shape_b), digest.add(e.point), digest.add(e.normal),
        digest.add(e.approach_speed);
  digest.add(events.hits.size());
  for (const SensorTouch& e : events.sensors)
    digest.add(e.sensor), digest.add(e.visitor), digest.add(std::size_t(e.begins));
  digest.add(events.sensors.size());
  for (const JointBroken& e : events.broken) digest.add(e.joint), digest.add(e.force), digest.add(e.torque);
  digest.add(events.broken.size());
  for (const SleepChange& e : events.sleep_changes) digest.add(e.body), digest.add(std::size_t(e.asleep));
  digest.add(events.sleep_changes.size());
  for (const SoftContactBegin& e : events.soft_begins)
    digest.add(e.soft), digest.add(e.shape), digest.add(e.body), digest.add(std::size_t(e.vertex));
  digest.add(events.soft_begins.size());
  for (const SoftContactEnd& e : events.soft_ends) digest.add(e.soft), digest.add(e.shape);
  digest.add(events.soft_ends.size());
  for (const SoftInverted& e : events.inverted) digest.add(e.soft), digest.add(std::size_t(e.tetrahedron));
  digest.add(events.inverted.size());
  for (const SoftTorn& e : events.torn)
    digest.add(e.soft), digest.add(std::size_t(e.vertex)), digest.add(std::size_t(e.new_vertex));
  digest.add(events.torn.size());
  for (const FluidTouch& e : events.fluid_touches)
    digest.add(e.fluid), digest.add(e.body), digest.add(e.soft), digest.add(std::size_t(e.vertex)),
        digest.add(std::size_t(e.begins));
  digest.add(events.fluid_touches.size());
  return digest.value();
}

inline void add_soft_readings(const World& world, Digest& digest) {
  std::vector<SoftId> softs(world.softs({}));
  world.softs(softs);
  for (const SoftId soft : softs) {
    const SoftInfo info = world.soft_info(soft);
    digest.add(soft), digest.add(info.mass), digest.add(info.kinetic_energy), digest.add(info.elastic_energy);
    digest.add(std::size_t(info.contacts)), digest.add(std::size_t(info.awake)), digest.add(info.pressure);
    for (const std::uint32_t corner : world.soft_triangles(soft)) digest.add(std::size_t(corner));
  }
}

inline void add_fluid_readings(const World& world, Digest& digest) {
  std::vector<FluidId> fluids(world.fluids({}));
  world.fluids(fluids);
  for (const FluidId fluid : fluids) {
    const FluidInfo info = world.fluid_info(fluid);
    digest.add(fluid), digest.add(std::size_t(info.particles)), digest.add(info.kinetic_energy);
    digest.add(info.smoke_mass), digest.add(info.fuel_mass), digest.add(info.pose.position);
    const Vec3 half{0.5f * float(info.cells[0]) * info.cell.x, 0.5f * float(info.cells[1]) * info.cell.y,
                    0.5f * float(info.cells[2]) * info.cell.z};
    const FluidProbe probe = world.probe(fluid, info.pose * (to_float(info.lower) + half));
    digest.add(probe.velocity), digest.add(probe.pressure);
  }
}

inline std::uint64_t digest_of_readings(const World& world) {
  Digest digest;
  std::vector<ContactPoint> points(world.contacts({}));
  world.contacts(points);
  for (const ContactPoint& p : points) {
    digest.add(p.shape_a), digest.add(p.shape_b), digest.add(p.position), digest.add(p.normal);
    digest.add(p.separation), digest.add(p.normal_impulse), digest.add(p.friction_impulse);
    digest.add(p.relative_velocity);
  }
  const BodyColumns bodies = world.bodies();
  for (std::size_t i = 0; i < bodies.ids.size(); ++i) {
    digest.add(bodies.ids[i]), digest.add(bodies.poses[i].position), digest.add(bodies.poses[i].orientation);
    digest.add(bodies.linear_velocities[i]), digest.add(std::size_t(world.is_awake(bodies.ids[i])));
  }
  add_soft_readings(world, digest), add_fluid_readings(world, digest);
  const Energy energy = world.energy();
  digest.add(energy.kinetic), digest.add(energy.potential), digest.add(energy.elastic);
  digest.add(world.momentum().angular), digest.add(world.max_penetration()), digest.add(world.time());
  return digest.value();
}

struct Seen {
  std::uint64_t state = 0, readings = 0, events = 0;
  std::size_t problems = 0;
};
inline Seen look(const World& world) {
  return {world.hash(), digest_of_readings(world), digest_of_events(world.events()), world.problems().size()};
}

// ------------------------------------------------------------------------------------------------------ the reference

// Where a run can be taken up again: the state and who drives it on.
template <class Driver>
struct Bookmark {
  int step = 0;         // steps that were done
  bool driven = false;  // the commands of the next step were given
  Driver driver;
  std::vector<std::byte> snapshot;
};

template <class Driver>
struct Reference {
  std::uint32_t number = 0;
  WorldDef def;
  std::vector<Seen> seen;  // after each step
  std::vector<Bookmark<Driver>> bookmarks;
  std::vector<std::byte> recording;
  int steps() const { return int(seen.size()); }
};

inline World make_world(const WorldDef& def) {
  Result<World> made = World::create(def);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

template <class Driver>
Reference<Driver> make_reference(std::uint32_t number, int steps) {
  Reference<Driver> reference;
  reference.number = number;
  Driver driver(number);
  reference.def = driver.def();
  reference.def.simd_width = 1;
  MemorySink sink;
  World world = make_world(reference.def);
  {
    Recorder recorder(world, sink);
    driver.build(world);
    Random dice(number);
    for (int step = 0; step < steps; ++step) {
      const bool mark = dice.next(0, 24) < 1.0f;
      const bool driven = dice.next(0, 2) < 1.0f;
      if (mark && !driven) reference.bookmarks.push_back({step, false, driver, save_snapshot(world)});
      driver.drive(world, step);
      if (mark && driven) reference.bookmarks.push_back({step, true, driver, save_snapshot(world)});
      world.step(driver.seconds(step));
      reference.seen.push_back(look(world));
    }
    EXPECT_TRUE(recorder.finish());
  }
  reference.recording = std::move(sink.bytes);
  return reference;
}

// --------------------------------------------------------------------------------------------------------- comparing

inline testing::AssertionResult equal(const Seen& a, const Seen& b, bool events, int step) {
  if (a.state != b.state) return testing::AssertionFailure() << "another state after step " << step;
  if (a.readings != b.readings) return testing::AssertionFailure() << "other readings after step " << step;
  if (events && a.events != b.events) return testing::AssertionFailure() << "other events of step " << step;
  if (a.problems != b.problems) return testing::AssertionFailure() << "other problems in step " << step;
  return testing::AssertionSuccess();
}

// Steps on to `end`. What commands told before a snapshot is not in it: then the first step's events may be fewer.
template <class Driver>
testing::AssertionResult follows(const Reference<Driver>& reference, World& world, Driver& driver, int begin,
                                 int end, bool driven = false) {
  for (int step = begin; step < end; ++step) {
    const bool pending = driven && step == begin;
    if (!pending) driver.drive(world, step);
    world.step(driver.seconds(step));
    Seen expected = reference.seen[std::size_t(step)], found = look(world);
    if (pending) expected.problems = found.problems;
    if (const auto result = equal(expected, found, !pending, step); !result) return result;
  }
  return testing::AssertionSuccess();
}

template <class Driver>
std::string first_place(const Reference<Driver>& reference, const WorldDef& def) {
  const Result<Difference> found = first_difference(reference.recording, def);
  if (!found) return std::string(" (") + found.error().message + ")";
  if (found->step == UINT64_MAX) return " (its recording plays without a difference)";
  return " (step " + std::to_string(found->step) + ", stage '" + found->stage + "', column '" +
         found->column + "', row " + std::to_string(found->row) + ")";
}

struct Way {
  int threads = 1, width = 0;
  BroadPhaseKind broad_phase = BroadPhaseKind::bvh;
};
inline WorldDef computed(WorldDef def, const Way& way) {
  def.threads = way.threads;
  def.simd_width = way.width;
  def.stepping.broad_phase = way.broad_phase;
  return def;
}
inline std::ostream& operator<<(std::ostream& out, const Way& way) {
  return out << way.threads << " threads, width " << way.width << ", broad phase "
             << to_string(way.broad_phase);
}

template <class Driver>
void expect_same_when_computed(const Reference<Driver>& reference, const Way& way) {
  const WorldDef def = computed(reference.def, way);
  World world = make_world(def);
  Driver driver(reference.number);
  driver.build(world);
  const auto result = follows(reference, world, driver, 0, reference.steps());
  EXPECT_TRUE(result) << "world " << reference.number << " with " << way << first_place(reference, def);
}

// A world that has lived another life: nothing of it may shine through what is loaded into it.
template <class Driver>
World make_used_world(std::uint32_t number, const Way& way) {
  Driver other(number);
  World world = make_world(computed(other.def(), way));
  other.build(world);
  for (int step = 0; step < 20; ++step) other.step(world, step);
  return world;
}

template <class Driver>
void expect_same_from_bookmarks(const Reference<Driver>& reference, const Way& way, int max_steps) {
  World used = make_used_world<Driver>(reference.number + 1000, way);
  for (const Bookmark<Driver>& mark : reference.bookmarks) {
    const int end = min(mark.step + max_steps, reference.steps());
    Driver driver = mark.driver;
    Result<World> loaded = load_snapshot(mark.snapshot, computed(reference.def, way));
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(save_snapshot(*loaded), mark.snapshot) << "world " << reference.number << " step " << mark.step;
    EXPECT_TRUE(follows(reference, *loaded, driver, mark.step, end, mark.driven))
        << "world " << reference.number << " loaded before step " << mark.step << " with " << way;
    driver = mark.driver;
    ASSERT_EQ(restore_snapshot(used, mark.snapshot).code, ErrorCode::none);
    EXPECT_TRUE(follows(reference, used, driver, mark.step, end, mark.driven))
        << "world " << reference.number << " restored before step " << mark.step << " with " << way;
  }
}

// Goes on, goes back, does something else meanwhile, goes back again, and in the end has done what the reference did.
template <class Driver>
void expect_same_with_rollback(const Reference<Driver>& reference, const Way& way) {
  constexpr int kBack = 7;
  World world = make_world(computed(reference.def, way));
  Driver driver(reference.number);
  driver.build(world);
  Rollback ring(kBack + 1);
  for (int begin = 0; begin < reference.steps(); begin += kBack) {
    const int end = min(begin + kBack, reference.steps());
    const Driver kept = driver;
    ring.save(world);
    ASSERT_TRUE(follows(reference, world, driver, begin, end))
        << "world " << reference.number << " with " << way;
    ASSERT_TRUE(ring.restore(world, std::uint64_t(begin)));
    Driver stranger(reference.number + 77);
    for (int step = begin; step < end; ++step) {
      stranger.step(world, step);
      ring.save(world);
    }
    ASSERT_TRUE(ring.restore(world, std::uint64_t(begin)));
    driver = kept;
    ASSERT_TRUE(follows(reference, world, driver, begin, end))
        << "world " << reference.number << " rolled back to " << begin << " with " << way;
  }
}

template <class Driver>
void expect_same_when_played(const Reference<Driver>& reference, const Way& way) {
  const WorldDef def = computed(reference.def, way);
  Result<Replay> replay = Replay::open(reference.recording, def);
  ASSERT_TRUE(replay) << replay.error().message;
  bool matches = true;
  for (int step = 0; step < reference.steps() && matches; ++step) {
    ASSERT_TRUE(replay->step(&matches));
    const Seen found = look(replay->world());
    EXPECT_EQ(found.readings, reference.seen[std::size_t(step)].readings) << step;
    EXPECT_EQ(found.events, reference.seen[std::size_t(step)].events) << step;
  }
  EXPECT_TRUE(matches) << "world " << reference.number << " played with " << way
                       << first_place(reference, def);
  Random dice(reference.number);
  for (int i = 0; i < 4; ++i) {
    const int to = int(dice.next(1, float(reference.steps())));
    ASSERT_EQ(replay->seek(std::uint64_t(to)).code, ErrorCode::none);
    EXPECT_EQ(replay->world().hash(), reference.seen[std::size_t(to - 1)].state)
        << "world " << reference.number << " sought step " << to << " with " << way;
  }
}

}  // namespace gyre::random_run
