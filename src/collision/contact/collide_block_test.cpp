// In blocks of contacts, where those with manifolds come first, each result belongs to its contact.
#include "collision/contact/collide_scene.h"
#include "random.h"

#include <gtest/gtest.h>

namespace gyre::collide_block_test {
namespace {

using testing_random::Random;

// Crossed sticks, half of them fixed: nearly all are near each other, so blocks of contacts are full, and few touch.
TEST(CollideBlock, MarksContactsWithStaticShapes) {
  Random random;
  CollideScene scene;
  for (int i = 0; i < 60; ++i)
    scene.add(Capsule{0.03f, 1.0f}, {DVec3(random.vector(-0.7f, 0.7f)), random.turn(3.0f)}, i % 2 == 0);
  int beside = 0, among = 0;
  for (int step = 0; step < 60; ++step) {
    for (ColliderBody& body : scene.bodies)
      if (body.awake) body.pose.position += random.vector(-0.02f, 0.02f);
    scene.step();
    for (std::uint32_t slot = 0; slot < scene.store.contacts.size(); ++slot) {
      const Contact& contact = scene.store.contacts[slot];
      if (contact.manifold_room == 0) continue;
      const bool has_points = contact.manifold_count != 0;
      const bool one_rests = scene.bodies[contact.body_a].awake != scene.bodies[contact.body_b].awake;
      ASSERT_EQ(scene.changes.on_static.test(slot), has_points && one_rests) << step << ", " << slot;
      beside += has_points && one_rests ? 1 : 0;
      among += has_points && !one_rests ? 1 : 0;
    }
  }
  EXPECT_GT(beside, 1000);
  EXPECT_GT(among, 500);
}

}  // namespace
}  // namespace gyre::collide_block_test
