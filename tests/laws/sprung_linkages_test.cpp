// Chains whose joints do work: springs, dampers, gears and curves between light bodies and heavy ones, thrown on the ground. What they lose
// they lose, but together with what springs hold they never have more than they began with.
#include "laws/assembly.h"

#include "random.h"

#include <cmath>

namespace gyre::laws {
namespace {

struct Tie {
  const char* name;
  double gain;  // of what there was, at most
  void (*make)(testing_random::Random& random, double mass, JointDef& joint);
};

// N/m (or N m/rad, of an arm of 0.15 m) and N s/m of a spring that the mass stretches by a metre to a millimetre, and that
// is damped within a step to half a minute.
float draw_stiffness(testing_random::Random& random, double mass) {
  return float(mass * 9.81 * std::pow(1000.0, double(random.real(0, 1))));
}
float draw_damping(testing_random::Random& random, double mass) {
  return float(mass * 0.03 * std::pow(2000.0, double(random.real(0, 1))));
}
JointAxisDef sprung(testing_random::Random& random, double mass) {
  JointAxisDef axis{.motion = AxisMotion::free};
  axis.stiffness = draw_stiffness(random, mass);
  axis.damping = draw_damping(random, mass);
  return axis;
}

constexpr double kSquareArm = 0.15 * 0.15;

const Tie kTies[] = {
    {"sliders on springs", 0.1,
     [](testing_random::Random& random, double mass, JointDef& joint) {
       joint.kind = JointKind::slider;
       joint.stiffness = draw_stiffness(random, mass);
       joint.damping = draw_damping(random, mass);
       joint.limits = Limits{-0.1f, 0.1f};
     }},
    {"hinges on springs", 0.1,
     [](testing_random::Random& random, double mass, JointDef& joint) {
       joint.kind = JointKind::hinge;
       joint.stiffness = draw_stiffness(random, kSquareArm * mass);
       joint.damping = draw_damping(random, kSquareArm * mass);
     }},
    {"six axes, some on springs", 0.1,
     [](testing_random::Random& random, double mass, JointDef& joint) {
       joint.kind = JointKind::six_dof;
       JointAxisDef* const axes[] = {&joint.linear_x,  &joint.linear_y,  &joint.linear_z,
                                     &joint.angular_x, &joint.angular_y, &joint.angular_z};
       for (int i = 0; i < 6; ++i)
         if (random.next(2) == 0) *axes[i] = sprung(random, i < 3 ? mass : kSquareArm * mass);
     }},
    {"gears", 0.1,
     [](testing_random::Random& random, double, JointDef& joint) {
       joint.kind = JointKind::gear;
       joint.axis_b = normalized(random.vector(-1, 1), {0, 1, 0});
       joint.ratio = random.real(0.3f, 3.0f);
     }},
    {"curves", 0.1,
     [](testing_random::Random& random, double, JointDef& joint) {
       joint.kind = JointKind::path;
       joint.path = {{}, random.vector(-0.3f, 0.3f), random.vector(-0.3f, 0.3f)};
       joint.path_orientation = PathOrientation(random.next(3));
     }},
};

double drop(std::uint32_t seed, const Tie& tie) {
  testing_random::Random random;
  random.state += seed * 0x9e3779b97f4a7c15u;
  Assembly chain({.sleeping = false});
  add_ground(chain.world, surface(0.5f));
  const std::uint32_t count = 2 + random.next(6);
  double before = 0.0;  // kg
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = 0.3 * i;
    BodyDef def{.pose = {{x, 0.25, 0}, random.turn(3.0f)},
                .linear_velocity = random.vector(-1, 1),
                .angular_velocity = random.vector(-5, 5)};
    def.mass = 1.0e-3f * std::pow(1000.0f, random.real(0, 1));
    chain.add(def, Capsule{random.real(0.01f, 0.05f), random.real(0.02f, 0.1f)});
    if (i > 0) {
      JointDef joint{.a = chain.bodies[i - 1], .b = chain.bodies[i], .anchor = {x - 0.15, 0.25, 0}};
      joint.axis = normalized(random.vector(-1, 1), {1, 0, 0});
      tie.make(random, std::min(before, double(*def.mass)), joint);
      EXPECT_TRUE(chain.world.add_joint(joint));
    }
    before = double(*def.mass);
  }
  const auto energy = [&] { return chain.energy() + chain.world.energy().elastic; };
  const double first = energy();
  double least = first, most = 0.0;
  for (int i = 0; i < 180; ++i) {
    EXPECT_TRUE(chain.world.step(kStep));
    most = std::max(most, (energy() - least) / first);
    least = std::min(least, energy());
    for (const Problem& problem : chain.world.problems()) ADD_FAILURE() << seed << ": " << problem.message;
  }
  return most;
}

TEST(SprungLinkages, HaveNoMoreThanTheyBeganWith) {
  for (const Tie& tie : kTies) {
    double most = 0.0;
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      const double one = drop(seed, tie);
      if (std::getenv("SHOW") && one > tie.gain) std::printf("%s %u: %g\n", tie.name, seed, one);
      most = std::max(most, one);
    }
    EXPECT_TRUE(limit_row((std::string(tie.name) + ", light and heavy, on the ground: energy gained").c_str(), most, tie.gain, 0.01));
  }
}

}  // namespace
}  // namespace gyre::laws
