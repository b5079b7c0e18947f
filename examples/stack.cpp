// A tower of forty boxes stands for a minute and neither sinks nor leans. The program reads bodies in bulk, as arrays.
#include <gyre/gyre.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace gyre;

int main() {
  constexpr int kBoxes = 40;
  Result<World> made = World::create({.sleeping = false});
  if (!made) {
    std::printf("no world: %s\n", made.error().message);
    return 1;
  }
  World world = *std::move(made);
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  std::vector<BodyId> tower;
  for (int i = 0; i < kBoxes; ++i) {
    tower.push_back(world.add_body({.pose = {.position = {0, 0.5 + i, 0}}}, {.geometry = Box{}}));
  }

  for (int i = 0; i < 60 * 60; ++i) world.step(1.0f / 60.0f);

  const DVec3 top = world.pose(tower.back()).position;
  const double sink = kBoxes - 0.5 - top.y;
  const double lean = std::hypot(top.x, top.z);
  std::printf("after a minute the top has sunk by %.6f m and wandered by %.6f m\n", sink, lean);

  // Element i of every array belongs to the same body. The arrays are valid until the next change or step.
  const BodyColumns bodies = world.awake_bodies();
  float fastest = 0;
  for (std::size_t i = 0; i < bodies.ids.size(); ++i) {
    const float speed = length(bodies.linear_velocities[i]);
    if (speed > fastest) fastest = speed;
  }
  std::printf("%zu bodies are awake, the fastest moves at %.6f m/s\n", bodies.ids.size(), double(fastest));
  return sink < 1e-3 && lean < 1e-3 ? 0 : 1;
}
