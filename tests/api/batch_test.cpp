// WorldBatch: each world has the bits of a world alone, resets go back to the start, warm batches allocate nothing, draws depend on
// nothing but seed, world, run and place. Replicas: bodies that follow another process keep their contacts.
#include "random.h"

#include <gyre/batch.h>
#include <gyre/memory.h>
#include <gyre/replay.h>
#include <gyre/replica.h>

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::batch_test {
namespace {

struct Heap {
  World world;
  std::vector<BodyId> boxes;
  JointId hinge{};
};

// Boxes, a hull and a mesh as ground, in the middle of their fall.
Heap make_heap(int steps = 20) {
  Heap heap{*World::create({.threads = 2})};
  World& w = heap.world;
  const std::vector<Vec3> ground{{-20, 0, -20}, {20, 0, -20}, {20, 0, 20}, {-20, 0, 20}};
  const std::vector<std::uint32_t> indices{0, 2, 1, 0, 3, 2};
  const Result<Geometry> mesh = cook_mesh({.vertices = ground, .indices = indices});
  w.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = *mesh});
  for (int i = 0; i < 6; ++i) {
    heap.boxes.push_back(w.add_body({.pose = {{0.1 * i, 1.0 + 1.2 * i, 0.05 * i}}},
                                    ShapeDef{.geometry = Box{{0.5f, 0.5f, 0.5f}}}));
  }
  heap.hinge = w.add_joint(HingeDef{.b = heap.boxes[5], .anchor = {0.5, 8, 0}, .axis = {0, 0, 1}});
  for (int i = 0; i < steps; ++i) w.step(1.0f / 60);
  return heap;
}

std::vector<std::uint64_t> hashes_of(const WorldBatch& batch) {
  std::vector<std::uint64_t> out(batch.size());
  EXPECT_TRUE(batch.hashes(out).ok());
  return out;
}

void set_channels(WorldBatch& batch, const Heap& heap) {
  const BatchReading readings[] = {
      {.kind = ReadingKind::position, .body = heap.boxes[0]},
      {.kind = ReadingKind::linear_velocity, .components = 5, .body = heap.boxes[1]},
      {.kind = ReadingKind::joint_position, .joint = heap.hinge},
      {.kind = ReadingKind::contact_force, .body = heap.boxes[0]}};
  const BatchAction actions[] = {{.kind = ActionKind::force, .components = 1, .body = heap.boxes[0]},
                                 {.kind = ActionKind::motor_force, .joint = heap.hinge}};
  ASSERT_TRUE(batch.set_observations(readings).ok());
  ASSERT_TRUE(batch.set_actions(actions).ok());
}

TEST(Batch, EachWorldHasTheBitsOfAWorldAlone) {
  Heap heap = make_heap();
  WorldBatch batch = *WorldBatch::create(heap.world, 5, 3);
  set_channels(batch, heap);
  ASSERT_EQ(batch.observation_width(), 7u);
  EXPECT_EQ(hashes_of(batch), std::vector<std::uint64_t>(5, heap.world.hash()));
  std::vector<float> actions, rows(5 * 7);
  for (int i = 0; i < 5; ++i) actions.insert(actions.end(), {1000.0f * float(i - 2), 300.0f * float(i - 1)});
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(batch.step(1.0f / 60, 2, actions, rows).ok());
  for (const std::size_t i : {std::size_t{0}, std::size_t{3}}) {
    World alone = *load_snapshot(save_snapshot(make_heap().world));
    const std::uint16_t number = alone.bodies().ids[0].world;
    BodyId box = heap.boxes[0];
    JointId hinge = heap.hinge;
    box.world = hinge.world = number;
    for (int step = 0; step < 40; ++step) {
      if (step % 2 == 0) {
        alone.set_motor(hinge, {.target_velocity = actions[2 * i + 1] < 0 ? -1e4f : 1e4f,
                                .max_force = std::fabs(actions[2 * i + 1])});
      }
      alone.add_force(box, {actions[2 * i], 0, 0});
      alone.step(1.0f / 60);
    }
    EXPECT_EQ(batch.world(i).hash(), alone.hash());
    EXPECT_EQ(rows[7 * i], float(alone.pose(box).position.x));
    EXPECT_EQ(rows[7 * i + 5], alone.joint_axis_state(hinge, JointAxis::angular_x).position);
  }
}

TEST(Batch, ThreadsChangeNoBitAndResetsGoBack) {
  Heap heap = make_heap();
  WorldBatch one = *WorldBatch::create(heap.world, 7, 1), many = *WorldBatch::create(heap.world, 7, 4);
  const BatchDraw draws[] = {
      {.kind = DrawKind::position,
       .body = heap.boxes[3],
       .low = {-0.2f, 0, -0.2f},
       .high = {0.2f, 0.5f, 0.2f}},
      {.kind = DrawKind::friction, .body = heap.boxes[0], .low = {0.1f, 0, 0}, .high = {2, 0, 0}}};
  ASSERT_TRUE(one.set_draws(draws, 5).ok() && many.set_draws(draws, 5).ok());
  const std::vector<std::uint64_t> start = hashes_of(one);
  EXPECT_NE(start[0], start[1]);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(one.step(1.0f / 60).ok() && many.step(1.0f / 60).ok());
  const std::vector<std::uint64_t> later = hashes_of(one);
  EXPECT_EQ(later, hashes_of(many));
  // A reset draws anew for the worlds that it names, and leaves the others alone.
  const std::vector<std::uint8_t> which{1, 0, 0, 0, 0, 0, 1};
  ASSERT_TRUE(one.reset(which).ok());
  const std::vector<std::uint64_t> after = hashes_of(one);
  EXPECT_EQ(after[3], later[3]);
  EXPECT_NE(after[0], start[0]);
  EXPECT_FALSE(one.drawn(0, 0) == many.drawn(0, 0));
  ASSERT_TRUE(one.set_draws(draws, 5).ok());
  EXPECT_EQ(hashes_of(one), start);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(one.step(1.0f / 60).ok());
  EXPECT_EQ(hashes_of(one), later);
}

TEST(Batch, DrawsLieInTheirRangeAndSpreadOverIt) {
  Heap heap = make_heap(0);
  WorldBatch batch = *WorldBatch::create(heap.world, 200, 1);
  const BatchDraw draw{
      .kind = DrawKind::linear_velocity, .body = heap.boxes[2], .low = {-1, 0, 3}, .high = {1, 0, 5}};
  ASSERT_TRUE(batch.set_draws({&draw, 1}, 3).ok());
  double mean_x = 0, mean_z = 0;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const Vec3 v = batch.world(i).linear_velocity(batch.body(i, heap.boxes[2]));
    EXPECT_EQ(v, batch.drawn(i, 0));
    EXPECT_TRUE(v.x >= -1 && v.x <= 1 && v.y == 0 && v.z >= 3 && v.z <= 5);
    mean_x += double(v.x) / 200, mean_z += double(v.z) / 200;
  }
  // Four standard errors of a mean of 200.
  EXPECT_NEAR(mean_x, 0, 4 * 0.577 / std::sqrt(200.0));
  EXPECT_NEAR(mean_z, 4, 4 * 0.577 / std::sqrt(200.0));
}

TEST(Batch, AWarmBatchAllocatesNothing) {
  Heap heap = make_heap();
  WorldBatch batch = *WorldBatch::create(heap.world, 4, 2);
  set_channels(batch, heap);
  std::vector<float> actions(8, 10.0f), rows(28);
  std::vector<Pose> poses(4 * batch.body_count());
  const auto run = [&] {
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(batch.step(1.0f / 60, 1, actions, rows).ok());
    ASSERT_TRUE(batch.columns(poses, {}, {}).ok());
    ASSERT_TRUE(batch.reset().ok());
  };
  run(), run();
  const std::uint64_t before = allocation_count();
  run();
  EXPECT_EQ(allocation_count(), before);
}

TEST(Batch, WorldsShareCookedGeometry) {
  Heap heap = make_heap();
  const WorldBatch batch = *WorldBatch::create(heap.world, 3, 1);
  const auto mesh_of = [](const World& world) {
    return std::get_if<Geometry>(world.geometry(world.shapes(world.bodies().ids[0])[0]));
  };
  EXPECT_EQ(mesh_of(batch.world(0))->data(), mesh_of(heap.world)->data());
  EXPECT_EQ(mesh_of(batch.world(2))->data(), mesh_of(heap.world)->data());
}

TEST(Batch, RefusalsNameTheWorldOrTheRow) {
  Heap heap = make_heap(0);
  EXPECT_FALSE(WorldBatch::create(heap.world, 0));
  EXPECT_FALSE(WorldBatch::create(heap.world, 60001));
  WorldBatch batch = *WorldBatch::create(heap.world, 3, 2);
  set_channels(batch, heap);
  std::vector<float> actions(6, 0.0f), rows(21);
  EXPECT_EQ(batch.step(0).code, ErrorCode::invalid_argument);
  EXPECT_EQ(batch.step(1.0f / 60, 1, std::span<const float>(actions).first(5)).code,
            ErrorCode::invalid_argument);
  actions[2] = std::nanf("");
  EXPECT_NE(std::string(batch.step(1.0f / 60, 1, actions, rows).message).find("world 1"), std::string::npos);
  EXPECT_TRUE(batch.step(1.0f / 60).ok());
  BatchReading reading{.body = heap.boxes[0]};
  reading.body.index = 99;
  EXPECT_EQ(batch.set_observations({&reading, 1}).code, ErrorCode::stale_id);
  const BatchDraw draw{
      .kind = DrawKind::restitution, .body = heap.boxes[0], .low = {2, 0, 0}, .high = {2, 0, 0}};
  EXPECT_NE(std::string(batch.set_draws({&draw, 1}, 1).message).find("world 0"), std::string::npos);
}

TEST(Replica, ABodyThatFollowsKeepsItsContactsAndTheirImpulses) {
  Heap heap = make_heap(120);
  World& w = heap.world;
  const BodyId box = heap.boxes[0];
  std::vector<ContactPoint> before(w.contacts({})), after(before.size());
  ASSERT_GT(w.contacts(before), 0u);
  const std::uint64_t hash = w.hash();
  EXPECT_TRUE(set_replica_motion(w, box, replica_motion(w, box)));
  EXPECT_EQ(w.hash(), hash);
  ReplicaMotion motion = replica_motion(w, box);
  motion.center.x += 1e-4;
  motion.linear_velocity.y += 0.01f;
  ASSERT_TRUE(set_replica_motion(w, box, motion));
  EXPECT_TRUE(replica_motion(w, box) == motion);
  ASSERT_EQ(w.contacts(after), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(after[i].normal_impulse, before[i].normal_impulse);
  EXPECT_TRUE(w.step(1.0f / 60));
  EXPECT_FLOAT_EQ(bounding_radius(w, box), std::sqrt(0.75f));
}

TEST(Replica, RefusesWhatItCannotFollow) {
  Heap heap = make_heap(0);
  World& w = heap.world;
  ReplicaMotion motion = replica_motion(w, heap.boxes[0]);
  EXPECT_FALSE(set_replica_motion(w, w.bodies().ids[0], motion));  // fixed
  motion.center.x = std::nan("");
  EXPECT_FALSE(set_replica_motion(w, heap.boxes[0], motion));
  motion = replica_motion(w, heap.boxes[0]);
  struct : ByteSink {
    bool write(std::span<const std::byte>) override { return true; }
  } sink;
  const Recorder recorder(w, sink);
  EXPECT_FALSE(set_replica_motion(w, heap.boxes[0], motion));
}

}  // namespace
}  // namespace gyre::batch_test
