// Makes a door on a hinge with limits and a motor, a lamp on a rope, and a chain that breaks.
#include <gyre/gyre.h>

#include <cstdio>

using namespace gyre;

int main() {
  World world = *World::create();
  bool good = true;

  // Anchors and axes are in world coordinates at the present poses. A null id stands for the world.
  const BodyId door = world.add_body({.pose = {.position = {0.5, 1, 0}}},
                                     {.geometry = Box{{0.5f, 1, 0.02f}}, .density = 600});
  const JointId hinge = world.add_joint(HingeDef{.b = door,
                                                 .anchor = {0, 1, 0},
                                                 .axis = {0, 1, 0},
                                                 .limits = Limits{-1.0f, 2.0f},
                                                 .motor = {.target_velocity = 1.0f, .max_force = 20.0f}});
  for (int i = 0; i < 60 * 4; ++i) world.step(1.0f / 60.0f);
  const float angle = world.joint_state(hinge).position;
  std::printf("the motor has opened the door to %.3f rad, its limit\n", double(angle));
  good = good && angle > 1.98f && angle < 2.02f;

  // A rope exerts no force while it is slack.
  const BodyId lamp = world.add_body({.pose = {.position = {5, 3, 0}}}, {.geometry = Sphere{0.2f}});
  const JointId rope =
      world.add_joint(DistanceDef{.b = lamp, .anchor = {5, 4, 0}, .min_length = 0.0f, .max_length = 2.0f});
  for (int i = 0; i < 60 * 10; ++i) world.step(1.0f / 60.0f);
  const float weight = 9.81f * world.mass_properties(lamp).mass;
  const JointState pull = world.joint_state(rope);
  std::printf("the lamp hangs on %.3f m of rope, which bears %.1f N (the lamp weighs %.1f N)\n",
              double(pull.position), double(length(pull.force)), double(weight));
  good = good && length(pull.force) > 0.98f * weight && length(pull.force) < 1.02f * weight;

  // A joint that breaks is reported as an event and removed.
  const BodyId weak = world.add_body({.pose = {.position = {10, 3, 0}}}, {.geometry = Sphere{0.2f}});
  const JointId thread =
      world.add_joint(BallDef{.b = weak, .anchor = {10, 3.2, 0}, .break_force = 0.5f * weight});
  for (int i = 0; i < 10; ++i) {
    world.step(1.0f / 60.0f);
    for (const JointBroken& broken : world.events().broken) {
      std::printf("a thread for %.1f N broke under %.1f N\n", double(0.5f * weight), double(broken.force));
    }
  }
  good = good && !world.exists(thread);
  return good ? 0 : 1;
}
