// Creates a world with a floor and lets a box fall on it.
#include <gyre/gyre.h>

#include <cstdio>

int main() {
  gyre::World world = *gyre::World::create();
  world.add_body({.type = gyre::BodyType::fixed}, {.geometry = gyre::Plane{}});
  const gyre::BodyId box = world.add_body({.pose = {.position = {0, 5, 0}}}, {.geometry = gyre::Box{}});
  for (int i = 0; i < 120; ++i) world.step(1.0f / 60.0f);
  std::printf("the box rests at a height of %.2f m\n", world.pose(box).position.y);
}
