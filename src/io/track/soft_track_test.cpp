// Tracks of ropes, cloths and solids: every frame within the stated accuracy, in any order, at a stated size.
#include <gyre/replay.h>
#include <gyre/track.h>

#include "io/chunk/chunks.h"
#include "io/track/track_writer.h"

#include "memory_sink.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace gyre::soft_track_test {
namespace {

constexpr RecordOptions kPosesOnly{.commands = false};

struct SoftCopy {
  SoftId id;
  SoftInfo info;
  std::vector<DVec3> vertices;
  std::vector<std::uint32_t> triangles;
};
using SoftFrame = std::vector<SoftCopy>;

SoftFrame copy_softs(const World& world) {
  std::vector<SoftId> ids(world.softs({}));
  world.softs(ids);
  SoftFrame frame;
  for (const SoftId id : ids) {
    const SoftVertices v = world.vertices(id);
    SoftCopy copy{id, world.soft_info(id), {}, {}};
    for (std::size_t i = 0; i < v.size(); ++i) copy.vertices.push_back(v.position(i));
    copy.triangles.assign(world.soft_triangles(id).begin(), world.soft_triangles(id).end());
    frame.push_back(std::move(copy));
  }
  return frame;
}

void expect_frame(PoseTrack& track, std::size_t number, const SoftFrame& expected) {
  ASSERT_TRUE(track.seek(number).ok());
  const TrackFrame frame = track.frame();
  const double accuracy = track.accuracy().position;
  ASSERT_EQ(frame.soft_ids.size(), expected.size());
  ASSERT_EQ(frame.softs.size(), expected.size());
  std::size_t total = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(frame.soft_ids[i].index, expected[i].id.index);
    EXPECT_EQ(frame.soft_ids[i].generation, expected[i].id.generation);
    const TrackSoft& soft = track.softs()[frame.softs[i]];
    EXPECT_EQ(soft.kind, expected[i].info.kind);
    EXPECT_EQ(soft.radius, expected[i].info.radius);
    EXPECT_EQ(soft.triangles, expected[i].triangles);
    const std::span<const DVec3> vertices = track.soft_vertices(i);
    ASSERT_EQ(vertices.size(), expected[i].vertices.size());
    ASSERT_EQ(vertices.size(), soft.vertices);
    total += vertices.size();
    for (std::size_t k = 0; k < vertices.size(); ++k)
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_LE(std::abs(vertices[k][axis] - expected[i].vertices[k][axis]), accuracy) << i << ' ' << k;
  }
  EXPECT_EQ(frame.vertices.size(), total);
  EXPECT_TRUE(track.soft_vertices(expected.size()).empty());
}

SoftId add_flag(World& world, int cells_x, int cells_z, DVec3 place = {0, 2, 0}) {
  const float cell = 0.025f;
  return world.add_cloth(
      {.grid = ClothGrid{.size = {cell * float(cells_x), cell * float(cells_z)}, .cells = {cells_x, cells_z}},
       .pose = {place, {}}});
}
SoftId add_line(World& world, DVec3 end) {
  return world.add_rope({.points = {{0, 2, 0}, end}, .segments = 12, .radius = 0.03f});
}

// A world whose soft matter comes, moves, stands, and goes.
struct Recorded {
  std::vector<std::byte> bytes;
  std::vector<SoftFrame> frames;
};
Recorded record_changes(const RecordOptions& options) {
  World world = *World::create();
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  world.add_body({.pose = {{0, 0.5, 0}, {}}}, {.geometry = Sphere{}});
  MemorySink sink;
  Recorder recorder(world, sink, options);
  Recorded recorded;
  recorded.frames.push_back(copy_softs(world));
  std::optional<SoftId> flag, line, cube;
  for (int step = 0; step < 150; ++step) {
    if (step == 3) flag = add_flag(world, 12, 8);
    if (step == 5) world.pin(*flag, 0), world.pin(*flag, 12);
    if (step == 10) line = add_line(world, {1, 2.5, 0.25});
    if (step == 20)
      cube = world.add_solid({.box = SolidBox{.half_extents = {0.2f, 0.2f, 0.2f}}, .pose = {{2, 1, 0}, {}}});
    if (step == 70) world.remove_soft(*line);
    if (step == 75) line = add_line(world, {-1, 2.5, 0.5});  // in the same slot, with the same surface
    if (step == 90) world.remove_soft(*flag), world.remove_soft(*cube);
    if (step == 100) world.remove_soft(*line);
    if (step == 105) flag = add_flag(world, 3, 3);
    world.step(1.0f / 60);
    recorded.frames.push_back(copy_softs(world));
  }
  EXPECT_TRUE(recorder.finish());
  recorded.bytes = std::move(sink.bytes);
  return recorded;
}

TEST(SoftTrack, ShowsEveryVertexForwardBackAndAnywhere) {
  for (const float accuracy : {1e-4f, 1e-6f}) {
    const Recorded recorded = record_changes({.pose_accuracy = accuracy});
    Result<PoseTrack> track = PoseTrack::open(recorded.bytes);
    ASSERT_TRUE(track) << track.error().message;
    EXPECT_LE(track->accuracy().position, double(accuracy));
    const std::size_t count = recorded.frames.size();
    ASSERT_EQ(track->frame_count(), count);
    for (std::size_t i = 0; i < count; ++i)
      ASSERT_NO_FATAL_FAILURE(expect_frame(*track, i, recorded.frames[i])) << i;
    for (std::size_t i = count; i-- > 0;)
      ASSERT_NO_FATAL_FAILURE(expect_frame(*track, i, recorded.frames[i])) << i;
    for (std::size_t i = 0; i < count; ++i)
      ASSERT_NO_FATAL_FAILURE(expect_frame(*track, i * 89 % count, recorded.frames[i * 89 % count]));
    // Three surfaces of which the rope's is used twice, and that of the small cloth.
    EXPECT_EQ(track->softs().size(), 4u);
  }
}

TEST(SoftTrack, ChangesTheVersionOfTheSetWithTheSet) {
  const Recorded recorded = record_changes(kPosesOnly);
  Result<PoseTrack> track = PoseTrack::open(recorded.bytes);
  ASSERT_TRUE(track);
  const auto version = [&](std::size_t frame) {
    EXPECT_TRUE(track->seek(frame).ok());
    return track->frame().set_version;
  };
  for (const std::size_t changed : {4u, 11u, 21u, 71u, 76u, 91u, 101u, 106u})
    EXPECT_GT(version(changed), version(changed - 1)) << changed;
  for (const std::size_t same : {3u, 5u, 22u, 64u, 128u}) EXPECT_EQ(version(same), version(same - 1)) << same;
}

// Vertices that jump as far as they may, and back.
TEST(SoftTrack, FollowsVerticesThatAreMovedFarAway) {
  World world = *World::create({.gravity = {}});
  const SoftId line = add_line(world, {1, 2, 0});
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  std::vector<SoftFrame> frames = {copy_softs(world)};
  const std::vector<Vec3> still(13);
  for (const double far : {0.0, 1.0e3, -1.0e7, 0.0, 1.0e-3}) {
    std::vector<DVec3> places = frames[0][0].vertices;
    for (DVec3& place : places) place = place + DVec3{far, -far, 0.5 * far};
    ASSERT_TRUE(world.set_vertices(line, places, still));
    world.step(1.0f / 60);
    frames.push_back(copy_softs(world));
  }
  ASSERT_TRUE(recorder.finish());
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track);
  for (std::size_t i = 0; i < frames.size(); ++i)
    ASSERT_NO_FATAL_FAILURE(expect_frame(*track, i, frames[i])) << i;
}

TEST(SoftTrack, ContinuesAfterASnapshotIsRestored) {
  World world = *World::create();
  SoftId flag = add_flag(world, 5, 5);
  MemorySink sink;
  Recorder recorder(world, sink);
  std::vector<SoftFrame> frames = {copy_softs(world)};
  const std::vector<std::byte> saved = save_snapshot(world);
  const auto steps = [&] {
    for (int i = 0; i < 4; ++i) {
      world.step(1.0f / 60);
      frames.push_back(copy_softs(world));
    }
  };
  steps();
  world.remove_soft(flag);
  flag = add_flag(world, 2, 7);
  steps();
  ASSERT_TRUE(restore_snapshot(world, saved).ok());
  steps();
  ASSERT_TRUE(recorder.finish());
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track);
  ASSERT_EQ(track->frame_count(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    ASSERT_NO_FATAL_FAILURE(expect_frame(*track, i, frames[i])) << i;
}

std::vector<ChunkKind> kinds_of(std::span<const std::byte> bytes) {
  ChunkReader reader(bytes);
  EXPECT_TRUE(reader.read_header().ok());
  std::vector<ChunkKind> kinds;
  for (Chunk chunk; reader.next(chunk);) kinds.push_back(chunk.kind);
  return kinds;
}

TEST(SoftTrack, AddsNothingToARecordingWithoutSoftMatter) {
  World world = *World::create();
  world.add_body({}, {.geometry = Sphere{}});
  const SoftId line = add_line(world, {1, 2, 0});
  world.remove_soft(line);
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  for (int i = 0; i < 3; ++i) world.step(1.0f / 60);
  ASSERT_TRUE(recorder.finish());
  for (const ChunkKind kind : kinds_of(sink.bytes)) EXPECT_LT(int(kind), int(ChunkKind::motion_hash));
}

TEST(SoftTrack, TellsNamesAndColours) {
  World world = *World::create();
  const SoftId flag = add_flag(world, 2, 2), line = add_line(world, {1, 2, 0});
  const BodyId body = world.add_body({}, {.geometry = Sphere{}});
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  const TrackColor colors[] = {{192, 16, 32}};
  recorder.label_soft(flag, "first");
  recorder.label_soft(flag, "flag", colors);
  recorder.label(body, "ball");
  ASSERT_TRUE(recorder.finish());
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track);
  EXPECT_EQ(track->soft_label(flag).name, "flag");
  ASSERT_EQ(track->soft_label(flag).colors.size(), 1u);
  EXPECT_EQ(track->soft_label(flag).colors[0], colors[0]);
  EXPECT_EQ(track->soft_label(line).name, "");
  EXPECT_EQ(track->label(body).name, "ball");
}

// A cloth of 40 x 40 cells that hangs by two corners and swings.
TEST(SoftTrack, OfASwingingClothTakesFewerThanTwoBytesAVertexAndFrame) {
  World world = *World::create({.threads = 2});
  const SoftId flag = add_flag(world, 40, 40);
  world.pin(flag, 0);
  world.pin(flag, 40);
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  const std::size_t before = sink.bytes.size();
  for (int i = 0; i < 120; ++i) world.step(1.0f / 60);
  const double bytes = double(sink.bytes.size() - before) / (120.0 * 41 * 41);
  RecordProperty("bytes_per_vertex_and_frame", std::to_string(bytes));
  EXPECT_LT(bytes, 2.0);
  EXPECT_GT(bytes, 0.5);  // it does move
}

// -------------------------------------------------------------------------------------------------------------- damage

struct Edited {
  ChunkKind kind;
  std::vector<std::byte> payload;
};
std::vector<Edited> split(std::span<const std::byte> bytes) {
  ChunkReader reader(bytes);
  EXPECT_TRUE(reader.read_header().ok());
  std::vector<Edited> chunks;
  for (Chunk chunk; reader.next(chunk);)
    chunks.push_back({chunk.kind, {chunk.payload.begin(), chunk.payload.end()}});
  return chunks;
}
std::vector<std::byte> join(const std::vector<Edited>& chunks) {
  ByteWriter out;
  write_recording_header(out, recording_layout(false));
  std::uint32_t number = 0;
  for (const Edited& chunk : chunks) write_chunk(out, chunk.kind, number++, chunk.payload);
  return out.take();
}
std::vector<Edited> small_recording() {
  World world = *World::create();
  add_flag(world, 2, 2);
  MemorySink sink;
  Recorder recorder(world, sink, kPosesOnly);
  for (int i = 0; i < 3; ++i) world.step(1.0f / 60);
  EXPECT_TRUE(recorder.finish());
  return split(sink.bytes);
}
Edited* find(std::vector<Edited>& chunks, ChunkKind kind) {
  for (Edited& chunk : chunks)
    if (chunk.kind == kind) return &chunk;
  return nullptr;
}

TEST(SoftTrack, RefusesASurfaceThatCannotBe) {
  const std::vector<std::uint32_t> triangle = {0, 1, 2}, beyond = {0, 1, 3}, half = {0, 1};
  const auto reads = [](SoftKind kind, float radius, std::uint32_t count,
                        const std::vector<std::uint32_t>& triangles) {
    ByteWriter out;
    write_track_soft(out, kind, radius, count, triangles);
    TrackSoft soft;
    return read_track_soft(out.view(), soft);
  };
  EXPECT_TRUE(reads(SoftKind::cloth, 0.1f, 3, triangle));
  EXPECT_FALSE(reads(SoftKind::cloth, 0.1f, 3, beyond));
  EXPECT_FALSE(reads(SoftKind::cloth, 0.1f, 3, half));
  EXPECT_FALSE(reads(SoftKind::cloth, -0.1f, 3, triangle));
  EXPECT_FALSE(reads(SoftKind::cloth, std::numeric_limits<float>::quiet_NaN(), 3, triangle));
  EXPECT_FALSE(reads(SoftKind(3), 0.1f, 3, triangle));
}

TEST(SoftTrack, RefusesVerticesWithoutTheirSurface) {
  std::vector<Edited> chunks = small_recording();
  std::erase_if(chunks, [](const Edited& chunk) { return chunk.kind == ChunkKind::track_soft; });
  EXPECT_FALSE(PoseTrack::open(join(chunks)));
}

// A surface that says it has four thousand million vertices must not cost their memory.
TEST(SoftTrack, RefusesMoreVerticesThanTheFileHolds) {
  std::vector<Edited> chunks = small_recording();
  Edited* const surface = find(chunks, ChunkKind::track_soft);
  ASSERT_NE(surface, nullptr);
  for (std::size_t i = 5; i < 9; ++i) surface->payload[i] = std::byte(0xff);
  EXPECT_FALSE(PoseTrack::open(join(chunks)));
}

TEST(SoftTrack, ReadsVerticesOfAnyBytesWithoutHarm) {
  std::vector<Edited> chunks = small_recording();
  Edited* const vertices = find(chunks, ChunkKind::track_vertices);
  ASSERT_NE(vertices, nullptr);
  const std::vector<std::byte> whole = vertices->payload;
  int refused = 0;
  for (std::size_t size = 1; size < whole.size(); ++size) {
    vertices->payload.assign(whole.begin(), whole.begin() + std::ptrdiff_t(size));
    refused += !PoseTrack::open(join(chunks));
  }
  EXPECT_EQ(refused, int(whole.size()) - 1);
  vertices->payload = whole;
  vertices->payload.push_back(std::byte(1));
  EXPECT_FALSE(PoseTrack::open(join(chunks)));
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    vertices->payload = whole;
    vertices->payload[bit / 8] ^= std::byte(1 << bit % 8);
    Result<PoseTrack> track = PoseTrack::open(join(chunks));
    if (!track) continue;
    for (std::size_t frame = 0; frame < track->frame_count(); ++frame) {
      if (!track->seek(frame).ok()) continue;
      for (const DVec3& place : track->frame().vertices) ASSERT_TRUE(is_finite(place));
    }
  }
}

}  // namespace
}  // namespace gyre::soft_track_test
