// An arm of three limbs that goes across is caught at its end. What its hand turns by in a part of a sub-step then, up to a radian,
// no row of a joint sees; all the same the joints must hold, and energy must not come from nowhere.
#include "laws/assembly.h"

namespace gyre::laws::whip_test {
namespace {

struct Whip {
  float speed;  // m/s
  double gap;   // m, at most
  double kept;  // of the energy that is left once it is caught, at least
};

// Something small that is fixed to the hand makes the arm one that is solved by itself; dry friction is swept beside the equations.
enum class Arm : std::uint8_t { plain, with_friction, alone };
void crack(const Whip& whip, Arm kind) {
  Assembly arm({.gravity = {0, 0, 0}, .sleeping = false});
  struct Limb {
    float length, mass;
  };
  double end = 0.0;
  BodyId last{};
  for (const Limb& limb : {Limb{0.28f, 2.0f}, Limb{0.27f, 1.2f}, Limb{0.19f, 0.45f}}) {
    BodyDef def{.pose = {{end + 0.5 * double(limb.length), 0, 0}}, .linear_velocity = {0, -whip.speed, 0}};
    def.mass = limb.mass;
    const BodyId body = arm.add(def, Box{{0.5f * limb.length, 0.04f, 0.03f}});
    arm.join(JointKind::ball, last, body, {end, 0, 0}, {0, 0, 1},
             kind == Arm::with_friction ? 1.0e-4f : 0.0f);
    last = body;
    end += double(limb.length);
  }
  if (kind == Arm::alone) {
    const DVec3 hand = arm.world.pose(last).position;
    BodyDef thumb{.pose = {hand}, .linear_velocity = {0, -whip.speed, 0}};
    thumb.mass = 1.0e-4f;
    arm.join(JointKind::fixed, last, arm.add(thumb, Sphere{0.02f}), hand);
  }
  arm.world.step(kStep);
  const double caught = arm.energy();
  double gap = 0.0, most = 0.0;
  for (int i = 0; i < 300; ++i) {
    gap = std::max(gap, arm.largest_gap());
    most = std::max(most, arm.energy());
    arm.world.step(kStep);
  }
  EXPECT_TRUE(limit_row("gap of an arm that is caught (m)", gap, whip.gap, 0.5 * whip.gap));
  EXPECT_TRUE(limit_row("energy that it gains", most / caught - 1.0, 1e-3, 1e-4));
  EXPECT_TRUE(limit_row("energy that it loses", 1.0 - arm.energy() / caught, 1.0 - whip.kept, 1e-2));
}

TEST(Whip, OfAnArmHoldsTogether) {
  for (const Whip& whip :
       {Whip{5, 0.0001, 0.99}, Whip{10, 0.0002, 0.99}, Whip{20, 0.015, 0.75}, Whip{38, 0.04, 0.7}}) {
    for (const Arm kind : {Arm::plain, Arm::with_friction, Arm::alone}) crack(whip, kind);
  }
}

}  // namespace
}  // namespace gyre::laws::whip_test
