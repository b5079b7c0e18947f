// A recording has a snapshot, every command and a hash of every step. A replay gives the same bits on any machine and any number of
// threads. So a file of some kilobytes is a whole session, and a bug report. A recording also has a pose track, which plays without
// simulation.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <cstdio>
#include <vector>

using namespace gyre;

namespace {

// The sink takes the bytes of the recording; here it is memory.
class MemorySink : public ByteSink {
 public:
  bool write(std::span<const std::byte> bytes) override {
    data.insert(data.end(), bytes.begin(), bytes.end());
    return true;
  }
  std::vector<std::byte> data;
};

}  // namespace

int main() {
  MemorySink sink;
  {
    World world = *World::create();
    world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
    Recorder recorder(world, sink);
    for (int i = 0; i < 120; ++i) {
      if (i % 10 == 0) {
        world.add_body({.pose = {.position = {0.1 * (i % 3), 4, 0.07 * (i % 5)}}},
                       {.geometry = Capsule{0.2f, 0.3f}});
      }
      world.step(1.0f / 60.0f);
    }
    if (!recorder.finish()) return 1;
  }
  std::printf("recorded 120 steps in %zu bytes\n", sink.data.size());

  // The replay chooses threads and SIMD width; the recording has the steps.
  Result<Replay> opened = Replay::open(sink.data, {.threads = 3, .simd_width = 1});
  if (!opened) {
    std::printf("%s\n", opened.error().message);
    return 1;
  }
  Replay replay = *std::move(opened);
  int equal = 0;
  bool matches = false;
  while (replay.step(&matches)) equal += matches;
  std::printf("%d of %d steps have the recorded hash\n", equal, int(replay.step_count()));

  // A replay can seek to any step.
  const Error error = replay.seek(45);
  if (error.code != ErrorCode::none) {
    std::printf("%s\n", error.message);
    return 1;
  }
  std::printf("at step 45 there are %d bodies\n", replay.world().counts().bodies);

  // The pose track needs no world and no simulation, and works in any version of Gyre.
  Result<PoseTrack> looked_at = PoseTrack::open(sink.data);
  if (!looked_at || looked_at->seek(100).code != ErrorCode::none) return 1;
  const TrackFrame frame = looked_at->frame();
  int awake = 0;
  for (const std::uint8_t moving : frame.awake) awake += moving;
  std::printf("after %.2f s, %d of %zu bodies are awake; the last is at a height of %.2f m\n", frame.time, awake,
              frame.ids.size(), frame.poses.back().position.y);
  return equal == 120 ? 0 : 1;
}
