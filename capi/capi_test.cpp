// The C interface beside the C++ one: the same bits, definitions of other sizes, refusals, handles, arrays, batches.
#include <gyre/c/gyre.h>

#include "scene/scene_reader.h"
#include "scene/scene_runner.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

using namespace gyre;

namespace {

std::string scene_path(const char* name) {
  return std::string(GYRE_SOURCE_DIR) + "/scenes/" + name + ".gyre.json";
}

GyreShapeDef shape_of(GyreAnyShape geometry) {
  GyreShapeDef def = gyre_shape_def_default();
  def.geometry = geometry;
  return def;
}
GyreAnyShape sphere(float radius) {
  GyreAnyShape shape{};
  shape.kind = GYRE_SHAPE_KIND_SPHERE;
  shape.as.sphere.radius = radius;
  return shape;
}
GyreAnyShape plane() {
  GyreAnyShape shape{};
  shape.kind = GYRE_SHAPE_KIND_PLANE;
  shape.as.plane = gyre_plane_default();
  return shape;
}

// A ball that falls on a plane.
struct Fall {
  GyreWorld* world = gyre_world_create(nullptr);
  GyreBodyId ball{};

  Fall() {
    GyreBodyDef ground = gyre_body_def_default();
    ground.type = GYRE_BODY_TYPE_FIXED;
    const GyreShapeDef floor = shape_of(plane());
    gyre_world_add_body(world, &ground, &floor, 1);
    GyreBodyDef def = gyre_body_def_default();
    def.pose.position = {0.25, 2.0, 0.0};
    def.has_mass = true;
    def.mass = 3.0f;
    const GyreShapeDef round = shape_of(sphere(0.3f));
    ball = gyre_world_add_body(world, &def, &round, 1);
  }
  ~Fall() { gyre_world_destroy(world); }
};

World fall_in_cpp() {
  World world = *World::create();
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  world.add_body({.pose = {.position = {0.25, 2.0, 0.0}}, .mass = 3.0f}, {.geometry = Sphere{0.3f}});
  return world;
}

}  // namespace

TEST(CInterface, AWorldHasTheBitsOfCpp) {
  Fall fall;
  World world = fall_in_cpp();
  for (int i = 0; i < 90; ++i) {
    ASSERT_TRUE(gyre_world_step(fall.world, 1.0f / 60.0f));
    world.step(1.0f / 60.0f);
    ASSERT_EQ(gyre_world_hash(fall.world), world.hash()) << i;
  }
  EXPECT_FLOAT_EQ(gyre_world_mass_properties(fall.world, fall.ball).mass, 3.0f);
  EXPECT_NEAR(gyre_world_pose(fall.world, fall.ball).position.y, 0.3, 1e-3);
}

TEST(CInterface, ASceneHasTheBitsOfCpp) {
  const std::string path = scene_path("machines");
  GyreScene* scene = gyre_scene_load(path.c_str(), 1, 0);
  ASSERT_NE(scene, nullptr) << gyre_last_error();
  SceneRunner runner = *SceneRunner::create(*load_scene(path), path);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(gyre_scene_step(scene) && runner.step());
  EXPECT_EQ(gyre_world_hash(gyre_scene_world(scene)), runner.world().hash());
  std::size_t bodies = 0;
  gyre_scene_bodies(scene, &bodies);
  EXPECT_EQ(bodies, runner.bodies().size());
  std::size_t written = 0;
  const char* text = gyre_scene_write(scene, &written);
  GyreScene* again = gyre_scene_read(text, written, 1, 0);
  ASSERT_NE(again, nullptr) << gyre_last_error();
  gyre_scene_destroy(again);
  gyre_scene_destroy(scene);
  EXPECT_EQ(gyre_scene_load("no such file", 1, 0), nullptr);
  EXPECT_NE(std::string(gyre_last_error()).find("no such file"), std::string::npos);
}

// A program that was compiled with an earlier header hands over shorter definitions; the fields that it does not know keep their defaults.
TEST(CInterface, DefinitionsOfEarlierHeadersAreTaken) {
  Fall fall;
  GyreBodyDef def;
  std::memset(&def, 0xff, sizeof def);
  const std::size_t early = offsetof(GyreBodyDef, linear_damping);
  gyre_body_def_init(&def, early);
  EXPECT_EQ(def.size, early);
  EXPECT_NE(def.linear_damping, 0.0f) << "beyond the size nothing is written";
  def.pose.position = {5.0, 1.0, 0.0};
  // Shapes of that header lie closer together in an array.
  const std::size_t short_shape = offsetof(GyreShapeDef, material);
  std::vector<unsigned char> rows(2 * short_shape);
  for (int i = 0; i < 2; ++i) {
    GyreShapeDef shape;
    gyre_shape_def_init(&shape, short_shape);
    shape.geometry = sphere(0.1f + 0.1f * float(i));
    std::memcpy(rows.data() + std::size_t(i) * short_shape, &shape, short_shape);
  }
  const GyreBodyId body =
      gyre_world_add_body(fall.world, &def, reinterpret_cast<const GyreShapeDef*>(rows.data()), 2);
  ASSERT_FALSE(GYRE_IS_NULL(body)) << gyre_last_error();
  std::size_t count = 0;
  const GyreShapeId* shapes = gyre_world_shapes(fall.world, body, &count);
  ASSERT_EQ(count, 2u);
  const GyreShapeId second = shapes[1];
  GyreAnyShape geometry{};
  ASSERT_TRUE(gyre_world_geometry(fall.world, second, &geometry));
  EXPECT_FLOAT_EQ(geometry.as.sphere.radius, 0.2f);
  GyreMaterial material = gyre_material_default();
  gyre_world_material(fall.world, second, &material);
  EXPECT_FLOAT_EQ(material.static_friction, Material{}.static_friction);
}

TEST(CInterface, WrongSizesAndNullHandlesAreRefusedInWords) {
  Fall fall;
  GyreBodyDef def{};
  EXPECT_TRUE(GYRE_IS_NULL(gyre_world_add_body(fall.world, &def, nullptr, 0)));
  EXPECT_NE(std::string(gyre_last_error()).find("GyreBodyDef: size is 0"), std::string::npos)
      << gyre_last_error();
  def.size = sizeof def + 8;
  EXPECT_TRUE(GYRE_IS_NULL(gyre_world_add_body(fall.world, &def, nullptr, 0)));
  EXPECT_FALSE(gyre_world_step(nullptr, 0.1f));
  EXPECT_STREQ(gyre_last_error(), "gyre_world_step: a handle is NULL, or its world is gone");
  EXPECT_FALSE(gyre_world_step(fall.world, -1.0f));
  EXPECT_EQ(gyre_last_error_code(), GYRE_ERROR_CODE_INVALID_ARGUMENT);
  GyreWorldDef world_def = gyre_world_def_default();
  world_def.threads = 1000;
  EXPECT_EQ(gyre_world_create(&world_def), nullptr);
  EXPECT_NE(std::string(gyre_last_error()).find("threads"), std::string::npos);
  gyre_world_destroy(nullptr);
  GyreShapeDef empty = gyre_shape_def_default();
  empty.geometry.kind = GYRE_SHAPE_KIND_HULL;
  empty.geometry.as.geometry = nullptr;
  EXPECT_TRUE(GYRE_IS_NULL(gyre_world_add_shape(fall.world, fall.ball, &empty)));
}

TEST(CInterface, ArraysAreThoseOfTheWorld) {
  Fall fall;
  for (int i = 0; i < 90; ++i) gyre_world_step(fall.world, 1.0f / 60.0f);
  const GyreBodyColumns bodies = gyre_world_bodies(fall.world);
  ASSERT_EQ(bodies.ids_count, 2u);
  ASSERT_EQ(bodies.poses_count, 2u);
  EXPECT_TRUE(GYRE_SAME_ID(bodies.ids[1], fall.ball));
  EXPECT_EQ(bodies.poses[1].position.y, gyre_world_pose(fall.world, fall.ball).position.y);
  EXPECT_EQ(bodies.poses, gyre_world_bodies(fall.world).poses) << "not a copy";
  GyreContactPoint points[4];
  ASSERT_EQ(gyre_world_contacts(fall.world, nullptr, 0), 1u);
  ASSERT_EQ(gyre_world_contacts(fall.world, points, 4), 1u);
  EXPECT_NEAR(points[0].normal_impulse * 60.0f, 3.0f * 9.81f, 0.5f);
  GyreRay rays[2] = {{{0.25, 5, 0}, {0, -10, 0}}, {{9, 5, 0}, {0, -10, 0}}};
  GyreCastHit hits[2];
  ASSERT_EQ(gyre_world_cast_ray_batch(fall.world, rays, 2, hits, 2, nullptr), GYRE_ERROR_CODE_NONE);
  EXPECT_TRUE(GYRE_SAME_ID(hits[0].body, fall.ball));
  EXPECT_NEAR(hits[1].fraction, 0.5, 1e-6);
}

TEST(CInterface, FluidsGoThereAndBack) {
  GyreWorld* world = gyre_world_create(nullptr);
  GyreFluidEmitter emitters[2] = {gyre_fluid_emitter_default(), gyre_fluid_emitter_default()};
  emitters[1].has_velocity = true;
  emitters[1].velocity = {0, 2, 0};
  GyreGasDef def = gyre_gas_def_default();
  def.cells[0] = def.cells[1] = def.cells[2] = 8;
  def.emitters = emitters;
  def.emitters_count = 2;
  const GyreFluidId gas = gyre_world_add_gas(world, &def);
  ASSERT_FALSE(GYRE_IS_NULL(gas)) << gyre_last_error();
  gyre_world_step(world, 0.01f);
  GyreGasDef back = gyre_gas_def_default();
  gyre_world_gas_def(world, gas, &back);
  ASSERT_EQ(back.emitters_count, 2u);
  EXPECT_TRUE(back.emitters[1].has_velocity);
  EXPECT_EQ(back.emitters[1].velocity.y, 2.0f);
  ASSERT_TRUE(back.has_fields);
  EXPECT_EQ(back.fields.density_count, 512u);
  EXPECT_FALSE(GYRE_IS_NULL(gyre_world_add_gas(world, &back))) << gyre_last_error();
  gyre_world_destroy(world);
}

TEST(CInterface, RecordingsReplay) {
  Fall fall;
  std::vector<std::uint8_t> bytes;
  const auto write = [](void* user, const std::uint8_t* more, std::size_t count) {
    auto& out = *static_cast<std::vector<std::uint8_t>*>(user);
    out.insert(out.end(), more, more + count);
    return true;
  };
  GyreRecorder* recorder = gyre_recorder_create(fall.world, write, &bytes, nullptr);
  ASSERT_NE(recorder, nullptr);
  EXPECT_EQ(gyre_recorder_create(fall.world, write, &bytes, nullptr), nullptr) << "one recorder a world";
  for (int i = 0; i < 20; ++i) gyre_world_step(fall.world, 1.0f / 60.0f);
  EXPECT_TRUE(gyre_recorder_finish(recorder));
  gyre_recorder_destroy(recorder);
  GyreReplay* replay = gyre_replay_open(bytes.data(), bytes.size(), nullptr);
  ASSERT_NE(replay, nullptr) << gyre_last_error();
  bool matches = false;
  while (gyre_replay_step(replay, &matches)) ASSERT_TRUE(matches);
  EXPECT_EQ(gyre_world_hash(gyre_replay_world(replay)), gyre_world_hash(fall.world));
  gyre_replay_destroy(replay);
}

TEST(CInterface, ARecorderThatOutlivesItsWorldRefuses) {
  GyreWorld* world = gyre_world_create(nullptr);
  const auto write = [](void*, const std::uint8_t*, std::size_t) { return true; };
  GyreRecorder* recorder = gyre_recorder_create(world, write, nullptr, nullptr);
  ASSERT_NE(recorder, nullptr);
  gyre_world_destroy(world);
  EXPECT_FALSE(gyre_recorder_finish(recorder));
  EXPECT_NE(std::string(gyre_last_error()).find("its world is gone"), std::string::npos);
  gyre_recorder_destroy(recorder);
}

TEST(CInterface, ABatchIsManyWorldsAlone) {
  Fall fall;
  GyreChannel reading{};
  reading.what = GYRE_READING_POSITION;
  reading.components = 3;  // x and y
  reading.body = fall.ball;
  GyreChannel action{};
  action.what = GYRE_ACTION_FORCE;
  action.components = 1;
  action.body = fall.ball;
  GyreBatch* batch = gyre_batch_create(fall.world, 5, 3);
  ASSERT_NE(batch, nullptr) << gyre_last_error();
  ASSERT_TRUE(gyre_batch_set_observations(batch, &reading, 1) && gyre_batch_set_actions(batch, &action, 1));
  ASSERT_EQ(gyre_batch_observation_width(batch), 2u);
  const float actions[5] = {0, 1, 2, 3, 4};
  float rows[10];
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(gyre_batch_step(batch, actions, rows, 2, 1.0f / 60.0f));
  for (int i = 0; i < 60; ++i) {
    gyre_world_add_force(fall.world, fall.ball, {3, 0, 0});
    gyre_world_step(fall.world, 1.0f / 60.0f);
  }
  EXPECT_EQ(gyre_world_hash(gyre_batch_world(batch, 3)), gyre_world_hash(fall.world));
  EXPECT_EQ(rows[6], float(gyre_world_pose(fall.world, fall.ball).position.x));
  reading.body.index = 77;
  EXPECT_FALSE(gyre_batch_set_observations(batch, &reading, 1));
  EXPECT_EQ(gyre_last_error_code(), GYRE_ERROR_CODE_STALE_ID);
  gyre_batch_destroy(batch);
}
