// A character climbs stairs, rides a lift, and rolls back to a saved state.
#include <gyre/gyre.h>
#include <gyre/kit/character.h>
#include <gyre/replay.h>

#include <cstdio>

using namespace gyre;

int main() {
  World world = *World::create({});
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  for (int i = 0; i < 8; ++i) {
    world.add_body({.type = BodyType::fixed, .pose = {{4.0 + 0.3 * i, 0.1 * (i + 1), 0}, {}}},
                   {.geometry = Box{{0.15f, 0.1f * float(i + 1), 1}}});
  }
  const BodyId lift = world.add_body({.type = BodyType::kinematic, .pose = {{7.3, 1.5, 0}, {}}},
                                     {.geometry = Box{{1, 0.1f, 1}}});

  const kit::CharacterDef def;  // 1.8 m, climbs 35 cm and 50 degrees
  kit::CharacterState hero = kit::make_character(def, {0, 0, 0});
  const float step = 1.0f / 60.0f;
  const auto play = [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      if (i == 230) world.set_velocity(lift, {0, 0.8f, 0}, {});
      world.step(step);
      const kit::CharacterMove move{.velocity = {i < 220 ? 2.0f : 0.0f, 0, 0}};
      if (const Error e = kit::move_character(world, def, hero, move, step); e.code != ErrorCode::none) {
        std::printf("%s\n", e.message);
        return;
      }
      if (i % 60 == 0) std::printf("%4d  x %5.2f  height %5.3f\n", i, hero.feet.x, hero.feet.y);
    }
  };

  play(0, 150);
  // The state is plain data: a copy of it beside a snapshot allows rollback of both.
  const auto moment = save_snapshot(world);
  const kit::CharacterState then = hero;
  play(150, 400);
  const DVec3 first = hero.feet;
  if (restore_snapshot(world, moment).code != ErrorCode::none) return 1;
  hero = then;
  play(150, 400);
  const bool same = hero.feet == first;
  std::printf("height %.3f, the same way again: %s\n", hero.feet.y, same ? "yes" : "no");
  return same && hero.feet.y > 3.0 ? 0 : 1;
}
