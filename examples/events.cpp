// The events of a step are arrays. Their order never depends on threads, and there are no callbacks.
#include <gyre/gyre.h>

#include <cstdio>

using namespace gyre;

int main() {
  World world = *World::create();
  const BodyId floor = world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  // A sensor pushes nothing and reports overlaps.
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0, 2, 0}}},
                 {.geometry = Box{{1, 0.25f, 1}}, .sensor = true});
  const BodyId ball = world.add_body({.pose = {.position = {0, 4, 0}}, .user_data = 7},
                                     {.geometry = Sphere{0.25f}, .material = {.restitution = 0.3f}});

  int entered = 0, left = 0, hits = 0, slept = 0;
  for (int i = 0; i < 60 * 6; ++i) {
    world.step(1.0f / 60.0f);
    const double now = world.time();
    const Events& events = world.events();
    for (const SensorTouch& touch : events.sensors) {
      std::printf("%.2f s: body %llu %s the sensor\n", now,
                  static_cast<unsigned long long>(world.user_data(world.body_of(touch.visitor))),
                  touch.begins ? "enters" : "leaves");
      ++(touch.begins ? entered : left);
    }
    for (const ContactHit& hit : events.hits) {
      std::printf("%.2f s: hit at %.1f m/s\n", now, double(hit.speed));
      ++hits;
    }
    for (const SleepChange& change : events.sleep_changes) {
      std::printf("%.2f s: the ball %s\n", now, change.asleep ? "falls asleep" : "wakes");
      slept += change.asleep && change.body == ball;
    }
  }

  // A wrong call changes nothing and says why.
  world.remove_body(floor);
  world.set_velocity(floor, {1, 0, 0}, {});
  for (const Problem& problem : world.problems()) std::printf("refused: %s\n", problem.message);
  return entered == 1 && left == 1 && hits > 0 && slept == 1 && !world.problems().empty() ? 0 : 1;
}
