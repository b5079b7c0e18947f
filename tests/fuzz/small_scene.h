// A small world with something of everything: each kind of shape, joints, contacts, a sleeping group, free slots.
#pragma once

#include "../determinism/scenes.h"

namespace gyre::fuzz {

inline void build_small_scene(World& world) {
  using namespace scenes;
  add_fixed(world, {}, Plane{});
  const float heights[] = {0, 0.25f, 0.5f, 0.125f, 0, __builtin_nanf(""), 0.25f, 0.25f, 0.5f};
  const Result<Geometry> field = cook_height_field({heights, 3, 3, 1});
  if (field) add_fixed(world, {10, 0, 0}, *field);
  const Vec3 corners[] = {{-1, 0, -1}, {1, 0, -1}, {-1, 0.25f, 1}, {1, 0, 1}};
  const std::uint32_t triangles[] = {0, 2, 1, 1, 2, 3};
  const Result<Geometry> mesh = cook_mesh({corners, triangles, true});
  if (mesh) add_fixed(world, {20, 0, 0}, *mesh);
  for (int i = 0; i < 7; ++i) add_moving(world, {double(i), 0.5, 0}, convex(i, 0.5f));
  add_moving(world, {10, 0.875, 0}, Sphere{0.5f});
  add_moving(world, {20, 0.625, 0}, Box{});
  const BodyId a = add_moving(world, {0, 3, 5}, Box{{0.25f, 0.25f, 0.25f}});
  const BodyId b = add_moving(world, {0.75, 3, 5}, Capsule{0.25f, 0.25f});
  join(world, JointKind::hinge, {}, a, {-0.5, 3, 5});
  join(world, JointKind::ball, a, b, {0.375, 3, 5});
  world.remove_body(add_moving(world, {5, 5, 5}, Sphere{}));
  for (int i = 0; i < 30; ++i) world.step(kStepSeconds);
  world.set_awake(body_number(world, 4), false);
}

}  // namespace gyre::fuzz
