// Islands that are solved directly as resting structures (rigid/rest/resting_structures.h). Their manifolds are older
// than any world.
#include "determinism/scenes.h"
#include "solver/rest/static_equilibrium.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::resting_structures_test {
namespace {

// The loaded contacts that a direct solver carries, and the others.
struct ContactCount {
  int rigid = 0, soft = 0;
};
ContactCount count_contacts(World& world) {
  ContactCount count;
  const ContactStore& store = state_of(world).rigid.contacts;
  for (const Contact& contact : store.contacts) {
    for (const Manifold& manifold : manifolds_of(store, contact)) {
      if (manifold.total_friction == Vec3{} && manifold.points[0].total_impulse == 0.0f) continue;
      ++(manifold.load_age >= kRigidContactAge ? count.rigid : count.soft);
    }
  }
  return count;
}

// Randomly oriented boxes that fall into a pit.
World make_heap(int boxes) {
  Result<World> world = World::create({.sleeping = false});
  EXPECT_TRUE(world);
  scenes::add_fixed(*world, {0, -0.5, 0}, Box{{50, 0.5f, 50}});
  const int side = int(std::cbrt(0.8 * boxes));
  const float pit = 0.75f * float(side) + 0.5f;
  for (const float side_sign : {-1.0f, 1.0f}) {
    scenes::add_fixed(*world, {double(side_sign * (pit + 0.5f)), 10, 0}, Box{{0.5f, 10, pit + 1}});
    scenes::add_fixed(*world, {0, 10, double(side_sign * (pit + 0.5f))}, Box{{pit + 1, 10, 0.5f}});
  }
  scenes::Random random(7);
  for (int i = 0; i < boxes; ++i) {
    const double x = 1.4 * (i % side - 0.5 * (side - 1)), z = 1.4 * (i / side % side - 0.5 * (side - 1));
    BodyDef body;
    body.pose = {{x, 1 + 1.4 * (i / (side * side)), z}, random.next_rotation()};
    world->add_body(body, {.geometry = Box{}});
  }
  return std::move(*world);
}

TEST(RestingStructures, APyramidIsSolvedDirectly) {
  World world = *World::create({.sleeping = false});
  scenes::add_fixed(world, {0, -0.5, 0}, Box{{50, 0.5f, 50}});
  for (int row = 0; row < 9; ++row)
    for (int i = 0; i < 9 - row; ++i)
      scenes::add_moving(world, {1.05 * (i + 0.5 * row), 0.5 + row, 0}, Box{});
  for (int i = 0; i < 120; ++i) world.step(scenes::kStepSeconds);
  const ContactCount count = count_contacts(world);
  EXPECT_GE(count.rigid, 45);
  EXPECT_EQ(count.soft, 0);
}

// One of its boxes slips more often than not: a search for an equilibrium takes many times as long as a step and
// finds none.
TEST(RestingStructures, AHeapOfManyBodiesIsNotSolvedDirectly) {
  World world = make_heap(60);
  int rigid_contacts = 0;
  for (int i = 0; i < 600; ++i) {
    world.step(scenes::kStepSeconds);
    if (i >= 300) rigid_contacts += count_contacts(world).rigid;
  }
  EXPECT_GT(count_contacts(world).soft, 60);
  EXPECT_EQ(rigid_contacts, 0);
}

}  // namespace
}  // namespace gyre::resting_structures_test
