// Linkages whose load contacts or fields bear. What joints give is watched, stage by stage, in those that are solved alone; between two
// stages the ground takes away what a joint seems to have given it, and this must not be made good by what swings on top.
#include "laws/assembly.h"

namespace gyre::laws::borne_linkages_test {
namespace {

// How far out the last body was at most in the last second of four, over the second before.
double kept_swing(Assembly& assembly) {
  double first = 0.0, last = 0.0;
  for (int i = 0; i < 240; ++i) {
    EXPECT_TRUE(assembly.world.step(kStep));
    const double out = std::abs(assembly.world.pose(assembly.bodies.back()).position.x);
    if (i < 120) first = std::max(first, out);
    if (i >= 120) last = std::max(last, out);
  }
  return last / first;
}
BodyDef body_of(float mass, DVec3 place) {
  BodyDef def{.pose = {.position = place}};
  def.mass = mass;
  return def;
}

TEST(BorneLinkages, APendulumSwingsOnAStandOnTheGround) {
  for (const float plate : {1.0f, 20.0f}) {
    for (const float column : {2.0f, 20.0f}) {
      Assembly stand({.sleeping = false});
      add_ground(stand.world, surface(0.6f));
      const BodyId foot = stand.add(body_of(plate, {0, 0.05, 0}), Box{{1, 0.05f, 1}});
      const BodyId post = stand.add(body_of(column, {0, 1.1, 0}), Box{{0.2f, 1, 0.2f}});
      const BodyId bob = stand.add(body_of(1, {0.3, 1.7, 0.4}), Sphere{0.05f});
      stand.join(JointKind::fixed, foot, post, {0, 0.1, 0});
      stand.join(JointKind::hinge, post, bob, {0, 2, 0.4});
      EXPECT_TRUE(relative_row("swing that is kept on a stand", kept_swing(stand), 1.0, 2e-2, 1e-3));
    }
  }
}

TEST(BorneLinkages, APendulumSwingsInAField) {
  Assembly chain({.gravity = {0, 0, 0}, .sleeping = false});
  FieldDef geometric_stiffness{.kind = FieldKind::radial};
  geometric_stiffness.center = {0, -1000, 0};
  geometric_stiffness.radius = 1000;
  geometric_stiffness.strength = 9.81f;
  ASSERT_TRUE(chain.world.add_field(geometric_stiffness));
  const BodyId link = chain.add(body_of(0.05f, {0.1, -0.5, 0}), Box{{0.02f, 0.02f, 0.02f}});
  const BodyId bob = chain.add(body_of(5, {0.2, -1, 0}), Box{{0.1f, 0.1f, 0.1f}});
  chain.join(JointKind::hinge, {}, link, {0, 0, 0});
  chain.join(JointKind::fixed, link, bob, {0.1, -0.5, 0});
  EXPECT_TRUE(relative_row("swing that is kept in a field", kept_swing(chain), 1.0, 2e-2, 1e-3));
}

// Energy and moments: 9.81 (3 - 2) kg 0.9 m over what turns.
TEST(BorneLinkages, ASeesawTipsOverToItsHeavySide) {
  Assembly seesaw({});
  add_ground(seesaw.world, surface(0.6f));
  const BodyId foot = seesaw.add(body_of(5, {0, 0.05, 0}), Box{{0.5f, 0.05f, 0.5f}});
  const BodyId post = seesaw.add(body_of(5, {0, 0.6, 0}), Box{{0.05f, 0.5f, 0.05f}});
  const BodyId beam = seesaw.add(body_of(5, {0, 1.1, 0}), Box{{1, 0.05f, 0.1f}});
  const BodyId heavy = seesaw.add(body_of(3, {-0.9, 1.1, 0}), Sphere{0.1f});
  const BodyId has_extreme_mass_ratio = seesaw.add(body_of(2, {0.9, 1.1, 0}), Sphere{0.1f});
  seesaw.join(JointKind::fixed, foot, post, {0, 0.1, 0});
  seesaw.join(JointKind::hinge, post, beam, {0, 1.1, 0});
  seesaw.join(JointKind::fixed, beam, heavy, {-0.9, 1.1, 0});
  seesaw.join(JointKind::fixed, beam, has_extreme_mass_ratio, {0.9, 1.1, 0});
  run(seesaw.world, 0.25);
  const double balls = 5.0 * (0.81 + 0.4 * 0.01), own = 5.0 * (4.0 + 0.01) / 12.0;
  const double turning = kGravity * 0.9 / (balls + own);  // rad/s^2, while it is level
  EXPECT_TRUE(relative_row("turning of a seesaw (rad/s)", double(seesaw.world.angular_velocity(beam).z),
                           0.25 * turning, 3e-2, 3e-3));
}

}  // namespace
}  // namespace gyre::laws::borne_linkages_test
