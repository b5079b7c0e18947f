// A user's program, smallest form: it must compile, link and run against an installed or embedded Gyre.
#include <gyre/gyre.h>

#include <cstdio>
#include <utility>

int main() {
  gyre::Result<gyre::World> made = gyre::World::create({});
  if (!made) {
    std::printf("no world: %s\n", made.error().message);
    return 1;
  }
  gyre::World world = *std::move(made);
  const gyre::BodyId ball =
      world.add_body({.pose = {.position = {0, 10, 0}}}, {.geometry = gyre::Sphere{0.5f}});
  for (int i = 0; i < 30; ++i) world.step(1.0f / 60.0f);
  const double height = world.pose(ball).position.y;
  std::printf("height %.3f\n", height);
  // Half a second of free fall from 10 m: 1.23 m lower, give or take the first-order error of one step.
  return height > 8.6 && height < 8.9 ? 0 : 1;
}
