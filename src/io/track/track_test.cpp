#include <gyre/track.h>

#include "io/chunk/chunks.h"
#include "io/track/track_writer.h"

#include "determinism/record_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

namespace gyre::track_test {
namespace {

using scenes::kScenes;
using scenes::Scene;
using scenes::step_scene;

constexpr RecordOptions kPosesOnly{.commands = false};

// A copy of the state that one frame shows.
struct FrameCopy {
  std::uint64_t step = 0;
  double time = 0;
  std::vector<BodyId> ids;
  std::vector<Pose> poses;
  std::vector<std::uint8_t> awake;
};
FrameCopy copy_frame(const World& world) {
  FrameCopy expected{world.step_count(), world.time(), {}, {}, {}};
  const BodyColumns bodies = world.bodies();
  expected.ids.assign(bodies.ids.begin(), bodies.ids.end());
  expected.poses.assign(bodies.poses.begin(), bodies.poses.end());
  for (const BodyId id : expected.ids) expected.awake.push_back(world.is_awake(id));
  return expected;
}

double angle_between(Quat a, Quat b) {
  return double(length(to_rotation_vector(normalized(conjugate(a) * b))));
}

void expect_same(const TrackFrame& frame, const FrameCopy& expected, const TrackAccuracy& accuracy) {
  ASSERT_EQ(frame.step, expected.step);
  ASSERT_EQ(frame.time, expected.time);
  ASSERT_EQ(frame.ids.size(), expected.ids.size());
  ASSERT_EQ(frame.poses.size(), expected.ids.size());
  ASSERT_EQ(frame.awake.size(), expected.ids.size());
  ASSERT_EQ(frame.models.size(), expected.ids.size());
  for (std::size_t i = 0; i < expected.ids.size(); ++i) {
    ASSERT_EQ(frame.ids[i].index, expected.ids[i].index);
    ASSERT_EQ(frame.ids[i].generation, expected.ids[i].generation);
    ASSERT_EQ(frame.awake[i], expected.awake[i]) << i;
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_LE(std::abs(frame.poses[i].position[axis] - expected.poses[i].position[axis]), accuracy.position)
          << i;
    // This angle itself has the precision of float.
    ASSERT_LE(angle_between(frame.poses[i].orientation, expected.poses[i].orientation),
              accuracy.orientation + 1e-6)
        << i;
  }
}

struct Recorded {
  std::vector<std::byte> bytes;
  std::vector<FrameCopy> frames;
};
Recorded record(const Scene& scene, int steps, const RecordOptions& options = {}, const WorldDef& def = {}) {
  Recorded recorded;
  recorded.bytes =
      scenes::record_scene(scene, steps, {.options = options, .world = def},
                           [&](const World& world) { recorded.frames.push_back(copy_frame(world)); });
  EXPECT_FALSE(recorded.bytes.empty());
  return recorded;
}

class TrackOfScene : public testing::TestWithParam<Scene> {};

TEST_P(TrackOfScene, ShowsEveryFrameForwardBackAndAnywhere) {
  const Recorded recorded = record(GetParam(), 200);
  Result<PoseTrack> track = PoseTrack::open(recorded.bytes);
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_FALSE(track->truncated());
  ASSERT_EQ(track->frame_count(), 201u);
  EXPECT_EQ(track->position(), 0u);
  const auto expect_frame = [&](std::size_t frame) {
    ASSERT_EQ(track->seek(frame).code, ErrorCode::none);
    ASSERT_EQ(track->position(), frame);
    ASSERT_EQ(track->step(frame), recorded.frames[frame].step);
    ASSERT_EQ(track->time(frame), recorded.frames[frame].time);
    expect_same(track->frame(), recorded.frames[frame], track->accuracy());
  };
  for (std::size_t i = 0; i <= 200; ++i) ASSERT_NO_FATAL_FAILURE(expect_frame(i)) << i;
  for (std::size_t i = 201; i-- > 0;) ASSERT_NO_FATAL_FAILURE(expect_frame(i)) << i;
  for (std::size_t i = 0; i <= 200; ++i) ASSERT_NO_FATAL_FAILURE(expect_frame(i * 89 % 201));
}

TEST_P(TrackOfScene, HasTheSameBytesForAnyThreadsAndWidth) {
  const Recorded one = record(GetParam(), 80, kPosesOnly);
  const Recorded other = record(GetParam(), 80, kPosesOnly, {.threads = 3, .simd_width = 1});
  EXPECT_EQ(one.bytes, other.bytes);
}

INSTANTIATE_TEST_SUITE_P(Scenes, TrackOfScene, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Trembling poses are not rounded in each frame, and their bits are reused. The poses read must be the same.
TEST(Track, ShowsEachPoseRoundedByItselfWhileAPileComesToRest) {
  const Recorded recorded = record(kScenes[1], 500, kPosesOnly, {.sleeping = false});
  Result<PoseTrack> track = PoseTrack::open(recorded.bytes);
  ASSERT_TRUE(track);
  ASSERT_EQ(track->frame_count(), recorded.frames.size());
  for (std::size_t f = 0; f < recorded.frames.size(); ++f) {
    ASSERT_EQ(track->seek(f).code, ErrorCode::none);
    for (std::size_t i = 0; i < recorded.frames[f].poses.size(); ++i)
      ASSERT_EQ(track->frame().poses[i], unrounded(round_pose(recorded.frames[f].poses[i], {}), {}))
          << f << ' ' << i;
  }
}

// A thousand boxes fall into a pit.
void build_pile(World& world) {
  scenes::add_fixed(world, {}, Plane{});
  scenes::add_fixed(world, {6.5, 4, 0}, Box{{0.5f, 4, 7}});
  scenes::add_fixed(world, {-6.5, 4, 0}, Box{{0.5f, 4, 7}});
  scenes::add_fixed(world, {0, 4, 6.5}, Box{{7, 4, 0.5f}});
  scenes::add_fixed(world, {0, 4, -6.5}, Box{{7, 4, 0.5f}});
  for (int i = 0; i < 1000; ++i) {
    const int x = i % 7, z = i / 7 % 7, y = i / 49;
    const Vec3 axis{float(i * 37 % 11) - 5, float(i * 53 % 13) - 6, float(i * 71 % 17) - 8};
    world.add_body(
        {.pose = {{1.6 * (x - 3) + 0.01 * (i % 19), 1.5 + 1.6 * y, 1.6 * (z - 3) + 0.01 * (i % 23)},
                  from_axis_angle(axis, 0.1f * float(i % 30))}},
        {.geometry = Box{}});
  }
}

TEST(Track, OfAThousandTumblingBoxesTakesFewerThanSixBytesABodyAndFrame) {
  World world = *World::create({.threads = 2});
  build_pile(world);
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  const std::size_t before = sink.bytes.size();
  std::size_t moved = 0;
  for (int i = 0; i < 300; ++i) {
    world.step(1.0f / 60);
    moved += std::size_t(world.stats().awake_bodies);
  }
  EXPECT_TRUE(recorder.finish());
  EXPECT_GT(moved, 250'000u);
  const double bytes = double(sink.bytes.size() - before) / double(moved);
  EXPECT_LT(bytes, 6.0);
  EXPECT_LT(bytes, 5.3);  // 5.0 when it was made; docs/decisions/track-coding.md
  RecordProperty("bytes_per_body_and_frame", std::to_string(bytes));
  EXPECT_LE(PoseTrack::open(sink.bytes)->accuracy().position, 1.0e-4);
  EXPECT_LE(PoseTrack::open(sink.bytes)->accuracy().orientation, 1.0e-4);
}

TEST(Track, SleepingAndFixedBodiesCostNothing) {
  World world = *World::create();
  scenes::add_fixed(world, {}, Plane{});
  for (int i = 0; i < 500; ++i) scenes::add_moving(world, {2.0 * i, 0.5, 0}, Box{});
  for (int i = 0; i < 200; ++i) world.step(1.0f / 60);
  ASSERT_EQ(world.stats().awake_bodies, 0);
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  const std::size_t before = sink.bytes.size();
  for (int i = 0; i < 60; ++i) world.step(1.0f / 60);
  EXPECT_LT(sink.bytes.size() - before, 60u * 50u);  // heads and checksums
}

TEST(Track, ShowsBodiesThatComeGoChangeAndArePutElsewhere) {
  World world = *World::create();
  scenes::add_fixed(world, {}, Plane{});
  const BodyId wall =
      world.add_body({.type = BodyType::fixed, .pose = {.position = {5, 1, 0}}}, {.geometry = Box{}});
  const BodyId sleeper = scenes::add_moving(world, {0, 0.5, 0}, Box{});
  for (int i = 0; i < 100; ++i) world.step(1.0f / 60);
  ASSERT_FALSE(world.is_awake(sleeper));
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  std::vector<FrameCopy> frames = {copy_frame(world)};
  const auto step = [&] {
    world.step(1.0f / 60);
    frames.push_back(copy_frame(world));
  };
  step();
  const BodyId ball = scenes::add_moving(world, {-3, 4, 0}, Sphere{0.25f});
  step();  // 2
  world.set_pose(wall, {{6, 2, 0}, from_axis_angle({0, 1, 0}, 0.5f)});
  step();  // 3
  step();  // 4
  world.add_shape(ball,
                  {.geometry = Capsule{}, .local = {{0, 1, 0}, {}}, .material = {.id = 7}, .sensor = true});
  step();  // 5
  world.remove_body(sleeper);
  step();  // 6
  const BodyId successor = scenes::add_moving(world, {1, 3, 1}, Cylinder{});
  ASSERT_EQ(successor.index, sleeper.index);
  step();  // 7
  world.remove_body(wall);
  const BodyId other = world.add_body({.type = BodyType::kinematic, .pose = {.position = {9, 9, 9}}});
  ASSERT_EQ(other.index, wall.index);
  step();  // 8
  world.set_type(other, BodyType::fixed);
  for (int i = 0; i < 80; ++i) step();
  ASSERT_TRUE(recorder.finish());

  Result<PoseTrack> opened = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(opened) << opened.error().message;
  PoseTrack& track = *opened;
  ASSERT_EQ(track.frame_count(), frames.size());
  for (std::size_t i = 0; i < 2 * frames.size(); ++i) {
    const std::size_t frame = i < frames.size() ? i : 2 * frames.size() - 1 - i;
    ASSERT_EQ(track.seek(frame).code, ErrorCode::none);
    ASSERT_NO_FATAL_FAILURE(expect_same(track.frame(), frames[frame], track.accuracy())) << frame;
  }
  const auto model = [&](std::size_t frame, BodyId body) -> const TrackModel& {
    EXPECT_EQ(track.seek(frame).code, ErrorCode::none);
    const TrackFrame view = track.frame();
    for (std::size_t i = 0; i < view.ids.size(); ++i) {
      if (view.ids[i].index == body.index) return track.models()[view.models[i]];
    }
    ADD_FAILURE() << "no such body in frame " << frame;
    return track.models()[0];
  };
  EXPECT_EQ(std::get<Sphere>(model(2, ball).shapes.at(0).geometry).radius, 0.25f);
  EXPECT_EQ(model(4, ball).shapes.size(), 1u);
  ASSERT_EQ(model(5, ball).shapes.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Capsule>(model(5, ball).shapes[1].geometry));
  EXPECT_EQ(model(5, ball).shapes[1].local.position, (Vec3{0, 1, 0}));
  EXPECT_EQ(model(5, ball).shapes[1].material_id, 7);
  EXPECT_TRUE(model(5, ball).shapes[1].sensor);
  EXPECT_TRUE(std::holds_alternative<Box>(model(5, sleeper).shapes.at(0).geometry));
  EXPECT_TRUE(std::holds_alternative<Cylinder>(model(7, successor).shapes.at(0).geometry));
  EXPECT_EQ(model(7, wall).type, BodyType::fixed);
  EXPECT_EQ(model(8, other).type, BodyType::kinematic);
  EXPECT_EQ(model(9, other).type, BodyType::fixed);
  EXPECT_TRUE(model(9, other).shapes.empty());
  // The version of the set changes if and only if the set changes.
  const auto version = [&](std::size_t frame) {
    EXPECT_EQ(track.seek(frame).code, ErrorCode::none);
    return track.frame().set_version;
  };
  for (const std::size_t changed : {2u, 5u, 6u, 7u, 8u, 9u})
    EXPECT_GT(version(changed), version(changed - 1)) << changed;
  for (const std::size_t same : {1u, 3u, 4u, 10u, 64u, 80u})
    EXPECT_EQ(version(same), version(same - 1)) << same;
}

TEST(Track, HoldsEveryKindOfShape) {
  World world = *World::create();
  const Vec3 corners[] = {{-1, 0, -1}, {1, 0, -1}, {-1, 0.25f, 1}, {1, 0, 1}};
  const std::uint32_t triangles[] = {0, 2, 1, 1, 2, 3};
  const float heights[] = {0, 0.25f, 0.5f, 0.125f, 0, __builtin_nanf(""), 0.25f, 0.25f, 0.5f};
  scenes::add_fixed(world, {}, Plane{{0, 1, 0.5f}, 2});
  scenes::add_fixed(world, {}, *cook_mesh({corners, triangles, true}));
  scenes::add_fixed(world, {}, *cook_height_field({heights, 3, 3, 2}));
  for (int i = 0; i < 7; ++i) scenes::add_moving(world, {3.0 * i, 50, 0}, scenes::convex(i, 0.5f));
  for (int i = 0; i < 7; ++i) scenes::add_moving(world, {3.0 * i, 60, 0}, scenes::convex(i, 0.5f));
  MemorySink sink;
  Recorder(world, sink, kPosesOnly).finish();
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track) << track.error().message;
  const TrackFrame frame = track->frame();
  ASSERT_EQ(frame.ids.size(), 17u);
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    const BodyId id = world.bodies().ids[i];
    const TrackModel& model = track->models()[frame.models[i]];
    EXPECT_EQ(model.type, world.type(id));
    ASSERT_EQ(model.shapes.size(), 1u);
    const AnyShape& drawn = model.shapes[0].geometry;
    const AnyShape& real = *world.geometry(world.shapes(id)[0]);
    ASSERT_EQ(drawn.index(), real.index());
    ByteWriter drawn_bytes, real_bytes;
    if (const Geometry* const cooked = std::get_if<Geometry>(&real)) {
      write_track_geometry(real_bytes, *cooked);
      write_track_geometry(drawn_bytes, std::get<Geometry>(drawn));
    } else {
      write_track_shape(real_bytes, {real, {}, 0, false}, 0);
      write_track_shape(drawn_bytes, model.shapes[0], 0);
    }
    EXPECT_EQ(drawn_bytes.take(), real_bytes.take()) << i;
  }
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(frame.models[3 + i], frame.models[10 + i]);  // alike
}

TEST(Track, TellsNamesColoursAndNotes) {
  World world = *World::create();
  const BodyId box = scenes::add_moving(world, {0, 1, 0}, Box{});
  const BodyId ball = scenes::add_moving(world, {3, 1, 0}, Sphere{});
  MemorySink sink;
  Recorder recorder(world, sink);
  const TrackColor colors[] = {{192, 128, 64}, {1, 2, 3}};
  recorder.label(box, "a wooden box", colors);
  recorder.label(ball, "first");
  recorder.note("scene", "{}");
  recorder.note("scene", "not this");
  world.step(1.0f / 60);
  recorder.label(ball, "b\xc3\xa4ll", std::span(colors).subspan(1));
  EXPECT_TRUE(recorder.finish());
  recorder.label(ball, "too late");
  Result<PoseTrack> opened = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(opened);
  const PoseTrack track = *std::move(opened);
  const TrackFrame frame = track.frame();
  EXPECT_EQ(track.label(frame.ids[0]).name, "a wooden box");
  ASSERT_EQ(track.label(frame.ids[0]).colors.size(), 2u);
  EXPECT_EQ(track.label(frame.ids[0]).colors[1], (TrackColor{1, 2, 3}));
  EXPECT_EQ(track.label(ball).name, "b\xc3\xa4ll");
  EXPECT_EQ(track.label(ball).colors.size(), 1u);
  EXPECT_EQ(track.label(BodyId{77, 1, 0}).name, "");
  EXPECT_EQ(track.note("scene"), "{}");
  EXPECT_EQ(track.note("other"), "");
}

TEST(Track, MayHaveFewerFramesThanStepsAndAnotherAccuracy) {
  World world = *World::create();
  scenes::add_moving(world, {0, 0.123456789, 0}, Box{});
  MemorySink sink;
  Recorder recorder(world, sink, {.commands = false, .frame_interval = 4, .pose_accuracy = 1e-7f});
  for (int i = 0; i < 10; ++i) world.step(1.0f / 60);
  EXPECT_TRUE(recorder.finish());
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track);
  ASSERT_EQ(track->frame_count(), 4u);
  const std::uint64_t steps[] = {0, 4, 8, 10};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(track->step(i), steps[i]);
  EXPECT_LE(track->accuracy().position, 1e-7);
  EXPECT_GT(track->accuracy().position, 0.5e-7);
  EXPECT_LE(std::abs(track->frame().poses[0].position.y - 0.123456789), 1e-7);
  for (const RecordOptions& wrong :
       {RecordOptions{.commands = false, .poses = false}, RecordOptions{.frame_interval = 0},
        RecordOptions{.hash_interval = 0},
        RecordOptions{.pose_accuracy = 0}, RecordOptions{.pose_accuracy = __builtin_nanf("")}}) {
    MemorySink nothing;
    Recorder refused(world, nothing, wrong);
    EXPECT_TRUE(refused.failed());
    EXPECT_FALSE(refused.finish());
    EXPECT_TRUE(nothing.bytes.empty());
  }
}

TEST(Track, GoesOnWhenTheWorldIsPutBack) {
  World world = *World::create();
  kScenes[0].build(world);
  MemorySink sink;
  Recorder recorder(world, sink);
  Rollback ring(4);
  std::vector<FrameCopy> frames = {copy_frame(world)};
  for (int i = 0; i < 30; ++i) {
    if (i == 10) ring.save(world);
    if (i == 12) scenes::add_moving(world, {0, 30, 0}, Sphere{});
    if (i == 20) {
      ASSERT_TRUE(ring.restore(world, 10));
    }
    step_scene(kScenes[0], world, i);
    frames.push_back(copy_frame(world));
  }
  ASSERT_TRUE(recorder.finish());
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track);
  ASSERT_EQ(track->frame_count(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(track->seek(i).code, ErrorCode::none);
    ASSERT_NO_FATAL_FAILURE(expect_same(track->frame(), frames[i], track->accuracy())) << i;
  }
  EXPECT_LT(track->step(21), track->step(20));
}

TEST(Track, IsReadUpToTheLastWholeFrameWhereverItIsCut) {
  const Recorded recorded = record(kScenes[4], 70, kPosesOnly);
  const PoseTrack whole = *PoseTrack::open(recorded.bytes);
  std::size_t frames_before = 0;
  std::size_t refused = 0;
  for (std::size_t size = 0; size < recorded.bytes.size(); size += 1 + size / 97) {
    Result<PoseTrack> cut =
        PoseTrack::open({recorded.bytes.begin(), recorded.bytes.begin() + std::ptrdiff_t(size)});
    if (!cut) {
      EXPECT_EQ(frames_before, 0u);
      EXPECT_NE(cut.error().message[0], '\0');
      ++refused;
      continue;
    }
    EXPECT_TRUE(cut->truncated());
    ASSERT_GE(cut->frame_count(), frames_before);
    frames_before = cut->frame_count();
    ASSERT_EQ(cut->seek(frames_before - 1).code, ErrorCode::none);
    expect_same(cut->frame(), recorded.frames[frames_before - 1], whole.accuracy());
  }
  EXPECT_GT(refused, 10u);
  EXPECT_GT(frames_before, 60u);
}

TEST(Track, AFrameThatLiesIsAnErrorAndThePresentOneStays) {
  std::vector<std::byte> bytes = record(kScenes[4], 70, kPosesOnly).bytes;
  // The last frame before the end chunk gets a bit more, under a checksum that is right.
  ChunkReader chunks(bytes);
  ASSERT_EQ(chunks.read_header().code, ErrorCode::none);
  Chunk chunk;
  std::span<const std::byte> last;
  while (chunks.next(chunk)) {
    if (chunk.kind == ChunkKind::track_frame) last = chunk.payload;
  }
  const std::size_t place = std::size_t(last.data() - bytes.data()) + kFrameHeadBytes;
  for (std::size_t i = place; i < place + 8; ++i) bytes[i] = std::byte(0xff);
  reseal_recording(bytes);
  Result<PoseTrack> track = PoseTrack::open(bytes);
  ASSERT_TRUE(track);
  ASSERT_EQ(track->frame_count(), 71u);
  ASSERT_EQ(track->seek(69).code, ErrorCode::none);
  EXPECT_EQ(track->seek(70).code, ErrorCode::invalid_data);
  EXPECT_EQ(track->position(), 69u);
  EXPECT_EQ(track->frame().step, 69u);
  EXPECT_EQ(track->seek(71).code, ErrorCode::invalid_argument);
  EXPECT_EQ(track->seek(68).code, ErrorCode::none);
}

TEST(Track, OfAnotherVersionsWorldIsReadWhereReplayIsRefused) {
  std::vector<std::byte> bytes = record(kScenes[1], 10).bytes;
  ASSERT_TRUE(Replay::open(bytes));
  bytes[16] ^= std::byte(1);  // the layout of the state, in the header
  const Result<Replay> replay = Replay::open(bytes);
  ASSERT_FALSE(replay);
  EXPECT_EQ(replay.error().code, ErrorCode::unsupported);
  const Result<PoseTrack> track = PoseTrack::open(bytes);
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->frame_count(), 11u);
}

// tests/recordings/everything_1.gyrec was written by the first version of the format, and stays as it is.
TEST(Track, WrittenByVersionOneIsStillRead) {
  std::ifstream file(GYRE_SOURCE_DIR "/tests/recordings/everything_1.gyrec", std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::byte* const bytes = reinterpret_cast<const std::byte*>(text.data());
  Result<PoseTrack> track = PoseTrack::open({bytes, bytes + text.size()});
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_FALSE(track->truncated());
  ASSERT_EQ(track->frame_count(), 151u);
  ASSERT_EQ(track->seek(150).code, ErrorCode::none);
  const TrackFrame frame = track->frame();
  EXPECT_NEAR(frame.time, 2.5, 1e-6);
  const char* const names[] = {"ground", "tile", "hills", "ball",  "dice",
                               "pill",   "tin",  "hat",   "stone", "hammer"};
  ASSERT_EQ(frame.ids.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(track->label(frame.ids[i]).name, names[i]);
  EXPECT_EQ(track->label(frame.ids[3]).colors[0], (TrackColor{0xc0, 0x40, 0x20}));
  EXPECT_EQ(frame.poses[3].position, (DVec3{4.74755859375, 1.0953369140625, -1.2524414062500}));
  EXPECT_LT(
      angle_between(frame.poses[9].orientation, {-0.342010498f, -0.198318481f, 0.915538389f, -0.0740814209f}),
      1e-5);
  EXPECT_EQ(frame.awake[3], 1);
  EXPECT_EQ(frame.awake[4], 0);
  const auto shape = [&](std::size_t body, std::size_t number = 0) -> const AnyShape& {
    return track->models()[frame.models[body]].shapes.at(number).geometry;
  };
  EXPECT_TRUE(std::holds_alternative<Plane>(shape(0)));
  EXPECT_EQ(view_mesh(std::get<Geometry>(shape(1))).indices.size(), 6u);
  EXPECT_EQ(view_height_field(std::get<Geometry>(shape(2))).columns, 3u);
  EXPECT_EQ(std::get<Sphere>(shape(3)).radius, 0.5f);
  EXPECT_EQ(std::get<Box>(shape(4)).rounding, 0.1f);
  EXPECT_EQ(std::get<Capsule>(shape(5)).half_height, 0.5f);
  EXPECT_EQ(std::get<Cylinder>(shape(6)).radius, 0.5f);
  EXPECT_EQ(std::get<Cone>(shape(7)).radius, 0.5f);
  EXPECT_EQ(view_hull(std::get<Geometry>(shape(8))).vertices.size(), 6u);
  EXPECT_EQ(std::get<Box>(shape(9, 1)).half_extents.x, 0.4f);
  EXPECT_NE(track->note("scene").find("something of everything"), std::string_view::npos);
}

TEST(Track, PassesOverChunksItDoesNotKnow) {
  const Recorded recorded = record(kScenes[1], 10);
  ByteWriter longer;
  write_recording_header(longer, recording_layout(true));
  ChunkReader chunks(recorded.bytes);
  ASSERT_EQ(chunks.read_header().code, ErrorCode::none);
  Chunk chunk;
  std::uint32_t number = 0;
  const std::byte strange[] = {std::byte(1), std::byte(2), std::byte(3)};
  while (chunks.next(chunk)) {
    write_chunk(longer, ChunkKind(300), number++, strange);
    write_chunk(longer, chunk.kind, number++, chunk.payload);
  }
  const std::vector<std::byte> bytes = longer.take();
  const Result<PoseTrack> track = PoseTrack::open(bytes);
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->frame_count(), 11u);
  EXPECT_FALSE(track->truncated());
  Result<Replay> replay = Replay::open(bytes);
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_EQ(replay->step_count(), 10u);
}

TEST(Track, OneHalfSaysWhatTheOtherIsFor) {
  const std::vector<std::byte> poses = record(kScenes[1], 3, {.commands = false}).bytes;
  const std::vector<std::byte> commands = record(kScenes[1], 3, {.poses = false}).bytes;
  EXPECT_TRUE(PoseTrack::open(poses));
  EXPECT_TRUE(Replay::open(commands));
  EXPECT_NE(std::string(Replay::open(poses).error().message).find("looked at only"), std::string::npos);
  EXPECT_NE(std::string(PoseTrack::open(commands).error().message).find("no poses"), std::string::npos);
  EXPECT_FALSE(PoseTrack::open({}));
  EXPECT_FALSE(PoseTrack::open(std::vector<std::byte>(100)));
}

}  // namespace
}  // namespace gyre::track_test
