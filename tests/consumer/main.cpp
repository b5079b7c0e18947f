// A user's program, smallest form: it must compile, link and run against an installed or embedded Gyre.
#include <gyre/gyre.h>
#include <gyre/kit/character.h>
#include <gyre/replay.h>

#include <cstdio>
#include <utility>
#include <vector>

namespace {

struct MemorySink : gyre::ByteSink {
  bool write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
  std::vector<std::byte> bytes;
};

}  // namespace

int main() {
  gyre::Result<gyre::World> made = gyre::World::create({});
  if (!made) {
    std::printf("no world: %s\n", made.error().message);
    return 1;
  }
  gyre::World world = *std::move(made);
  const gyre::BodyId ball =
      world.add_body({.pose = {.position = {0, 10, 0}}}, {.geometry = gyre::Sphere{0.5f}});
  MemorySink sink;
  gyre::Recorder recorder(world, sink);
  for (int i = 0; i < 30; ++i) world.step(1.0f / 60.0f);
  if (!recorder.finish()) return 1;
  const double height = world.pose(ball).position.y;
  gyre::Result<gyre::PoseTrack> track = gyre::PoseTrack::open(sink.bytes);
  if (!track || track->seek(30)) return 1;
  const double shown = track->frame().poses[0].position.y;
  if (shown - height > 1e-4 || height - shown > 1e-4) return 1;
  // The kit comes along with the package.
  const gyre::kit::CharacterDef walker;
  gyre::kit::CharacterState state = gyre::kit::make_character(walker, {0, 5, 0});
  if (gyre::kit::move_character(world, walker, state, {}, 1.0f / 60.0f)) return 1;
  if (!(state.feet.y < 5)) return 1;
  std::printf("height %.3f\n", height);
  // Half a second of free fall from 10 m: 1.23 m lower, give or take the first-order error of one step.
  return height > 8.6 && height < 8.9 ? 0 : 1;
}
