// Rollback, as in networked games: the world steps with a guess of the input of the other player. When the true input arrives, the
// world rolls back, applies it, and steps again. It then has the same bits as a world that knew the input from the start.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <cinttypes>
#include <cstdio>
#include <vector>

using namespace gyre;

namespace {

constexpr float kStep = 1.0f / 60.0f;

BodyId build(World& world) {
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  for (int i = 0; i < 30; ++i) {
    world.add_body({.pose = {.position = {0.3 * (i % 5), 0.5 + 1.01 * (i / 5), 0.2 * (i % 3)}}},
                   {.geometry = Box{}});
  }
  return world.add_body({.pose = {.position = {-5, 0.5, 0}}}, {.geometry = Sphere{0.5f}, .density = 5000});
}

}  // namespace

int main() {
  // This world knows all input in time: the player kicks the ball in step 20.
  World informed = *World::create();
  const BodyId informed_ball = build(informed);
  for (int i = 0; i < 60; ++i) {
    if (i == 20) informed.add_impulse(informed_ball, {20000, 0, 0});
    informed.step(kStep);
  }

  // This world learns of the kick only ten steps later.
  World late = *World::create();
  const BodyId late_ball = build(late);
  Rollback ring(16);
  for (int i = 0; i < 30; ++i) {
    ring.save(late);  // the state before step i
    late.step(kStep);
  }
  if (!ring.restore(late, 20)) return 1;
  late.add_impulse(late_ball, {20000, 0, 0});
  while (late.step_count() < 60) late.step(kStep);
  std::printf("informed %016" PRIx64 "\nlate     %016" PRIx64 "\n", informed.hash(), late.hash());

  // A snapshot has the same state as bytes, for a file or the network.
  const std::vector<std::byte> bytes = save_snapshot(late);
  Result<World> loaded = load_snapshot(bytes);
  if (!loaded) {
    std::printf("%s\n", loaded.error().message);
    return 1;
  }
  std::printf("loaded   %016" PRIx64 ", from %zu bytes\n", loaded->hash(), bytes.size());
  return informed.hash() == late.hash() && loaded->hash() == late.hash() ? 0 : 1;
}
