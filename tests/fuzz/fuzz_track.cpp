// Tracks from outside: refused, or looked at forward and back, the same each time; and the bits of a single frame.
#include "../memory_sink.h"
#include "base/hash.h"
#include "edits.h"
#include "io/chunk/chunks.h"
#include "io/track/soft_coder.h"
#include "io/track/track_coder.h"
#include "small_scene.h"

#include <cstdlib>

namespace {

using namespace gyre;

// Bodies of every kind and soft matter that come, go and change, over two keyframes.
const std::vector<std::byte>& good_track() {
  static const std::vector<std::byte> bytes = [] {
    World world = *World::create();
    fuzz::build_small_scene(world);
    MemorySink sink;
    {
      Recorder recorder(world, sink, {.commands = false});
      const TrackColor colors[] = {{1, 2, 3}};
      recorder.label(world.bodies().ids[4], "a name", colors);
      recorder.note("scene", "{}");
      const SoftId sheet = world.add_cloth({.grid = ClothGrid{.cells = {3, 2}}, .pose = {{40, 3, 0}, {}}});
      recorder.label_soft(sheet, "a sheet");
      SoftId line = world.add_rope({.points = {{50, 3, 0}, {51, 3, 0}}, .segments = 4});
      for (int step = 0; step < 70; ++step) {
        if (step < 46) scenes::drive_changes(world, step);
        if (step == 20) world.remove_soft(line);
        if (step == 30) line = world.add_rope({.points = {{50, 3, 0}, {50, 3, 2}, {51, 3, 2}}});
        world.step(scenes::kStepSeconds);
      }
    }
    return sink.bytes;
  }();
  return bytes;
}

// A number that tells frames apart.
std::uint64_t look(const TrackFrame& frame) {
  Hasher hasher;
  hasher.add(frame.step);
  hasher.add(std::as_bytes(frame.poses));
  hasher.add(std::as_bytes(frame.awake));
  hasher.add(std::as_bytes(frame.models));
  for (const BodyId id : frame.ids) hasher.add(std::uint64_t(id.index) << 16 | id.generation);
  hasher.add(std::as_bytes(frame.vertices));
  hasher.add(std::as_bytes(frame.softs));
  for (const SoftId id : frame.soft_ids) hasher.add(std::uint64_t(id.index) << 16 | id.generation);
  return hasher.value();
}

void check_frame(const PoseTrack& track) {
  const TrackFrame frame = track.frame();
  if (frame.ids.size() != frame.poses.size() || frame.ids.size() != frame.models.size()) std::abort();
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    if (!is_finite(frame.poses[i]) || frame.models[i] >= track.models().size()) std::abort();
    if (i > 0 && frame.ids[i - 1].index >= frame.ids[i].index) std::abort();
  }
  if (frame.soft_ids.size() != frame.softs.size()) std::abort();
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < frame.softs.size(); ++i) {
    if (frame.softs[i] >= track.softs().size()) std::abort();
    const TrackSoft& soft = track.softs()[frame.softs[i]];
    if (track.soft_vertices(i).size() != soft.vertices) std::abort();
    for (const std::uint32_t vertex : soft.triangles)
      if (vertex >= soft.vertices) std::abort();
    if (i > 0 && frame.soft_ids[i - 1].index >= frame.soft_ids[i].index) std::abort();
    vertices += soft.vertices;
  }
  if (vertices != frame.vertices.size()) std::abort();
  for (const DVec3& vertex : frame.vertices)
    if (!is_finite(vertex)) std::abort();
}

void try_track(const std::vector<std::byte>& bytes) {
  Result<PoseTrack> track = PoseTrack::open(bytes);
  if (!track) return;
  const std::size_t count = track->frame_count();
  if (count == 0) std::abort();
  if (count > 200) return;  // only bytes that were made to last are that long
  std::vector<std::uint64_t> looks;
  for (std::size_t i = 0; i < count; ++i) {
    if (track->seek(i)) break;
    check_frame(*track);
    looks.push_back(look(track->frame()));
  }
  // Back by leaps, each of which decodes all that came since a keyframe.
  for (std::size_t i = looks.size(); i > 0;) {
    i = i > 23 ? i - 23 : 0;
    if (track->seek(i) || look(track->frame()) != looks[i]) std::abort();
  }
  if (looks.size() < count) {
    // What cannot be shown leaves the present frame as it is.
    if (track->seek(looks.size()).code != ErrorCode::invalid_data) std::abort();
    if (looks.empty() || look(track->frame()) != looks[0]) std::abort();
  }
  (void)track->label(BodyId{0, 1, 0});
  (void)track->note("scene");
}

// Two frames of nothing but the input.
void try_bits(std::span<const std::byte> bits) {
  const std::size_t half = bits.size() / 2;
  constexpr std::uint32_t kVertexCounts[] = {0, 1, 3, 50};
  std::vector<TrackedSoft> softs;
  if (decode_softs(bits.first(half), kVertexCounts, softs))
    (void)decode_softs(bits.subspan(half), kVertexCounts, softs);
  std::vector<TrackedBody> bodies;
  FrameDecoder decoder(4, {});
  if (!decoder.decode(bits.first(half), bodies)) return;
  (void)decoder.decode(bits.subspan(half), bodies);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> raw = std::as_bytes(std::span(data, size));
  try_bits(raw);
  try_track({raw.begin(), raw.end()});
  fuzz::Input input(data, size);
  std::vector<std::byte> bytes = fuzz::edited(good_track(), input);
  try_track(bytes);
  reseal_recording(bytes);
  try_track(bytes);
  return 0;
}
