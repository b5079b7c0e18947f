// Things made of many joints: chains, bridges, linkages with more joints than they need, loops. They must not stretch, must
// not gain energy, and must keep their momentum. docs/decisions/articulations.md has the figures.
#include "laws/assembly.h"

#include <gyre/debug.h>

#include <string>

namespace gyre::laws::linkage_test {
namespace {

// ------------------------------------------------------------------------------------------------------------- chains

enum class Links { balls, hinges, rods };

struct ChainCase {
  Links links = Links::balls;
  bool swings = false;
  int count = 100;
  float load = 1000.0f;  // mass of the last body, that of the others being 1
  int substeps = 4;
};

constexpr double kPitch = 0.5;

// The most that the chain is ever longer than it was, over its length.
double worst_stretch(const ChainCase& c, double seconds) {
  Assembly chain({.stepping = {.substeps = c.substeps}, .sleeping = false});
  const DVec3 way = c.swings ? DVec3{1, 0, 0} : DVec3{0, -1, 0};
  const Quat turn = c.swings ? from_axis_angle({0, 0, 1}, -0.5f * kPi) : Quat{};
  BodyId last{};
  for (int i = 0; i < c.count; ++i) {
    BodyDef def{.pose = {(double(i) + 0.5) * kPitch * way, turn}};
    def.mass = i + 1 == c.count ? c.load : 1.0f;
    const BodyId body = chain.add(def, Capsule{0.05f, 0.15f});
    if (c.links == Links::rods) {
      chain.world.add_joint(
          DistanceDef{.a = last, .b = body, .anchor = std::max(0.0, i - 0.5) * kPitch * way});
    } else {
      chain.join(c.links == Links::balls ? JointKind::ball : JointKind::hinge, last, body,
                 double(i) * kPitch * way);
    }
    last = body;
  }
  double worst = 0.0;
  for (double t = 0.0; t < seconds; t += double(kStep)) {
    chain.world.step(kStep);
    double sum = chain.sum_of_gaps();
    if (c.links == Links::rods) {
      DVec3 from{};
      for (const BodyId body : chain.bodies) {
        const DVec3 to = chain.world.pose(body).position;
        sum += std::fabs(length(to - from) - (body == chain.bodies[0] ? 0.5 : 1.0) * kPitch);
        from = to;
      }
    }
    worst = std::max(worst, sum / (kPitch * c.count));
  }
  return worst;
}

TEST(Chain, HoldsAThousandTimesItsLinks) {
  for (const Links links : {Links::balls, Links::hinges, Links::rods}) {
    EXPECT_TRUE(
        limit_row("stretch of 100 links, 1:1000, hanging", worst_stretch({links, false}, 3.0), 1e-2, 1e-3));
    EXPECT_TRUE(
        limit_row("stretch of 100 links, 1:1000, swinging", worst_stretch({links, true}, 5.0), 1e-2, 2e-3));
  }
}

TEST(Chain, HoldsOtherLoadsLengthsAndSubsteps) {
  EXPECT_TRUE(limit_row("1:1", worst_stretch({.swings = true, .load = 1.0f}, 5.0), 1e-2, 1e-4));
  EXPECT_TRUE(limit_row("1:10,000, hanging", worst_stretch({.load = 1.0e4f}, 3.0), 1e-2, 1e-3));
  EXPECT_TRUE(
      limit_row("1:10,000, swinging", worst_stretch({.swings = true, .load = 1.0e4f}, 5.0), 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("20 links", worst_stretch({.swings = true, .count = 20}, 5.0), 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("1,000 links", worst_stretch({.count = 1000}, 0.5), 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("one sub-step", worst_stretch({.swings = true, .substeps = 1}, 5.0), 1e-2, 1e-3));
}

// twenty links and a ball of 200 times a link's mass, let go at 60 degrees, swing as one rigid pendulum would.
TEST(Chain, WreckingBallKeepsTime) {
  Assembly chain({.sleeping = false});
  const double angle = kPiDouble / 3.0;
  const DVec3 way{std::sin(angle), -std::cos(angle), 0};
  const double link = 0.25;
  BodyId last{};
  double moment = 0.0, mass_times_arm = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double arm = (i + 0.5) * link;
    const BodyId body = chain.add(point_body(1.0, {0.005f, 0.005f, 0.005f}, arm * way), Sphere{0.02f}, 0.0f);
    chain.join(JointKind::ball, last, body, double(i) * link * way);
    moment += arm * arm + 0.005;
    mass_times_arm += arm;
    last = body;
  }
  const double arm = 20 * link + 0.4;
  const BodyId ball = chain.add(point_body(200.0, {12.8f, 12.8f, 12.8f}, arm * way), Sphere{0.4f}, 0.0f);
  chain.join(JointKind::ball, last, ball, 20 * link * way);
  moment += 200.0 * arm * arm + 12.8;
  mass_times_arm += 200.0 * arm;
  double a = 1.0, g = std::cos(0.5 * angle);
  for (int i = 0; i < 30; ++i) {
    const double mean = 0.5 * (a + g);
    g = std::sqrt(a * g);
    a = mean;
  }
  const double period = 2.0 * kPiDouble * std::sqrt(moment / (mass_times_arm * kGravity)) / a;
  ZeroCrossings through;
  for (int i = 0; i < 60 * 40 && through.count() <= 5; ++i) {
    through.add(double(i) * double(kStep), chain.world.pose(ball).position.x);
    chain.world.step(kStep);
  }
  EXPECT_TRUE(relative_row("A-114 period", through.mean_period(), period, 3e-2, 5e-3));
  EXPECT_TRUE(limit_row("A-114 links apart (m)", chain.largest_gap(), 1e-3, 1e-4));
}

// The chain is longer than its nail is high: the ball strikes the ground, and the blow must not come back as speed.
TEST(Chain, WreckingBallStrikesTheGroundWithoutGainingEnergy) {
  for (const float restitution : {0.0f, 0.5f}) {
    for (const int substeps : {1, 4, 8}) {
      Assembly chain({.stepping = {.substeps = substeps}, .sleeping = false});
      add_ground(chain.world);
      BodyId last{};
      for (int i = 0; i < 24; ++i) {
        const BodyId body = chain.add({.pose = {{0.3 * i + 0.15, 6, 0}, from_axis_angle({0, 0, 1}, 0.5f * kPi)}},
                                      Capsule{0.05f, 0.1f}, 7850.0f);
        chain.join(JointKind::ball, last, body, {0.3 * i, 6, 0});
        last = body;
      }
      const BodyId ball = chain.world.add_body({.pose = {.position = {7.6, 6, 0}}},
                                               {.geometry = Sphere{0.4f},
                                                .density = 7850.0f,
                                                .material = surface(0.5f, restitution)});
      chain.join(JointKind::ball, last, ball, {7.2, 6, 0});
      const double start = chain.energy();
      double most = start;
      for (int i = 0; i < 300; ++i) {
        chain.world.step(kStep);
        most = std::max(most, chain.energy());
      }
      EXPECT_TRUE(limit_row("energy gained in blows, of that at the start", most / start - 1.0, 1e-2, 1e-3));
      // With one sub-step a link of 0.3 m that whips at 40 rad/s turns by a third of a radian at a time, and its ends stray from
      // what rows see by half of the square of that, times its length.
      EXPECT_TRUE(limit_row("gap after blows (m)", chain.largest_gap(), substeps == 1 ? 2e-2 : 1e-2, 1e-3));
    }
  }
}

// forty links of 0.1 m between points 3 m apart, damped until they hang: the sag of a catenary.
TEST(Chain, HangsAsACatenary) {
  Assembly chain({.sleeping = false});
  const double link = 0.1;
  // An arc of the right span to begin with: chord over arc = sin(t) / t = 3 / 4.
  double low = 0.1, high = 3.0;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (std::sin(t) / t > 0.75 ? low : high) = t;
  }
  DVec3 at{-1.5, 0, 0};
  double chord = 0.0;
  const auto direction = [&](int i) { return -low + 2.0 * low * (i + 0.5) / 40.0; };
  for (int i = 0; i < 40; ++i) chord += link * std::cos(direction(i));
  BodyId last{};
  for (int i = 0; i < 40; ++i) {
    const double d = direction(i);
    const DVec3 way{std::cos(d) * 3.0 / chord, std::sin(d) * 3.0 / chord, 0};  // 0.03 % longer
    BodyDef def = point_body(0.1, {1e-4f, 1e-4f, 1e-4f}, at + 0.5 * link * way);
    def.linear_damping = def.angular_damping = 1.0f;
    const BodyId body = chain.add(def, Sphere{0.01f}, 0.0f);
    chain.join(JointKind::ball, last, body, at);
    at = at + link * way;
    last = body;
  }
  chain.join(JointKind::ball, last, {}, at);
  run(chain.world, 20.0);
  double lowest = 0.0;
  for (const BodyId body : chain.bodies) lowest = std::min(lowest, chain.world.pose(body).position.y);
  EXPECT_TRUE(relative_row("A-46 sag (m)", -lowest, 1.17734, 1e-2, 1e-3));
  const JointState end = chain.world.joint_state(chain.joints[0]);
  const double weight_per_metre = 40 * 0.1 * kGravity / 4.0;
  EXPECT_TRUE(relative_row("A-46 horizontal tension", std::fabs(double(end.force.x)) / weight_per_metre,
                           1.11008, 1e-2, 2e-3));
  EXPECT_TRUE(relative_row("A-46 tension at the end", double(length(end.force)) / weight_per_metre, 2.28742,
                           3e-2, 2e-3));
}

// -------------------------------------------------------------------------------------------------------- energy etc.

// `count` rods of 1 m, one hanging on the other, let go level.
double energy_drift(int count, JointKind kind, int substeps, double seconds) {
  Assembly rods({.stepping = {.substeps = substeps}, .sleeping = false});
  BodyId last{};
  for (int i = 0; i < count; ++i) {
    const BodyId body = rods.add({.pose = {.position = {i + 0.5, 0, 0}}}, Box{{0.5f, 0.05f, 0.05f}});
    rods.join(kind, last, body, {double(i), 0, 0});
    last = body;
  }
  const double mass = double(rods.world.mass_properties(last).mass);
  const double range = 2.0 * mass * kGravity * 0.5 * count * count;  // between hanging and standing
  const double start = rods.energy();
  double worst = 0.0;
  for (int i = 0; i < int(seconds * 60.0); ++i) {
    rods.world.step(kStep);
    worst = std::max(worst, std::fabs(rods.energy() - start) / range);
  }
  return worst;
}

TEST(DoublePendulum, KeepsItsEnergyForAMinute) {
  EXPECT_TRUE(limit_row("hinges, 16 sub-steps", energy_drift(2, JointKind::hinge, 16, 60.0), 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("balls, 16 sub-steps", energy_drift(2, JointKind::ball, 16, 60.0), 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("three rods, 16 sub-steps", energy_drift(3, JointKind::hinge, 16, 60.0), 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("hinges, 4 sub-steps", energy_drift(2, JointKind::hinge, 4, 60.0), 1e-2, 5e-3));
}

TEST(FreeChain, KeepsItsMomentumAndEnergy) {
  for (const JointKind kind : {JointKind::ball, JointKind::hinge}) {
    for (const int count : {2, 10, 60}) {
      Assembly chain({.gravity = {0, 0, 0}, .sleeping = false});
      BodyId last{};
      for (int i = 0; i < count; ++i) {
        const float f = float(i);
        const BodyId body =
            chain.add({.pose = {.position = {double(i), 0, 0}},
                       .linear_velocity = {0, float(std::sin(0.7 * i)), float(std::cos(1.0 * i))},
                       .angular_velocity = {1, 0.3f * f / float(count), -0.5f}},
                      Box{{0.5f, 0.1f, 0.05f}});
        if (i > 0) chain.join(kind, last, body, {i - 0.5, 0, 0}, i % 2 == 0 ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
        last = body;
      }
      chain.world.step(kStep);  // velocities now agree with the joints
      const auto spin = [&] {   // about the common centre of mass
        double mass = 0.0;
        DVec3 center{};
        for (const BodyId body : chain.bodies) {
          const double m = double(chain.world.mass_properties(body).mass);
          center = center + m * chain.world.center_of_mass(body);
          mass += m;
        }
        const Momentum momentum = chain.world.momentum();
        return momentum.angular - cross((1.0 / mass) * center, momentum.linear);
      };
      const DVec3 before = spin();
      const double energy = chain.energy();
      double worst = 0.0;
      for (int i = 0; i < 1200; ++i) {
        chain.world.step(kStep);
        worst = std::max(worst, length(spin() - before) / length(before));
      }
      EXPECT_TRUE(limit_row("angular momentum of a free chain, 20 s", worst, 1e-3, 1e-4));
      EXPECT_TRUE(limit_row("its energy", std::fabs(chain.energy() / energy - 1.0), 1e-2, 1e-3));
    }
  }
}

// ------------------------------------------------------------------------------------------------- loops and linkages

void add_ring(Assembly& ring, int count, JointKind kind, double spin) {
  const double radius = 0.3 * count / (2.0 * kPiDouble);
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * kPiDouble * i / count;
    ring.add({.pose = {{radius * std::cos(a), radius * std::sin(a), 0}, from_axis_angle({0, 0, 1}, float(a))},
              .linear_velocity = {float(-spin * radius * std::sin(a)), float(spin * radius * std::cos(a)), 0},
              .angular_velocity = {0, 0, float(spin)}},
             Capsule{0.05f, 0.1f});
  }
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * kPiDouble * (i + 0.5) / count;
    ring.join(kind, ring.bodies[std::size_t(i)], ring.bodies[std::size_t((i + 1) % count)],
              {radius * std::cos(a), radius * std::sin(a), 0});
  }
}

// twenty links in a ring. Hinges with parallel axes say more about a ring than need be said.
TEST(Ring, SpinsForAMinute) {
  for (const JointKind kind : {JointKind::ball, JointKind::hinge}) {
    Assembly ring({.gravity = {0, 0, 0}, .sleeping = false});
    add_ring(ring, 20, kind, 5.0);
    const double spin = ring.world.momentum().angular.z;
    double gap = 0.0;
    for (int i = 0; i < 3600; ++i) {
      ring.world.step(kStep);
      gap = std::max(gap, ring.largest_gap());
    }
    EXPECT_TRUE(limit_row("A-44 gap (m)", gap, 1e-3, 1e-5));
    EXPECT_TRUE(relative_row("A-44 angular momentum", ring.world.momentum().angular.z, spin, 1e-3, 1e-4));
    DVec3 center{};
    for (const BodyId body : ring.bodies) center = center + (1.0 / 20.0) * ring.world.pose(body).position;
    EXPECT_TRUE(limit_row("A-44 centre (m)", length(center), 1e-3, 1e-5));
  }
}

TEST(Ring, HangsAndWhipsWithoutGainingEnergy) {
  for (const JointKind kind : {JointKind::ball, JointKind::hinge}) {
    Assembly ring({.sleeping = false});
    add_ring(ring, 20, kind, 0.0);
    ring.join(JointKind::ball, {}, ring.bodies[0], ring.world.pose(ring.bodies[0]).position);
    const double start = ring.energy();
    const double scale = 20.0 * double(ring.world.mass_properties(ring.bodies[0]).mass) * kGravity * 2.0;
    double gap = 0.0, gain = 0.0;
    for (int i = 0; i < 3600; ++i) {
      ring.world.step(kStep);
      gap = std::max(gap, ring.largest_gap());
      gain = std::max(gain, (ring.energy() - start) / scale);
    }
    EXPECT_TRUE(limit_row("gap while it whips (m)", gap, 1e-2, 1e-3));
    EXPECT_TRUE(limit_row("energy gained, of its weight times its length", gain, 2e-2, 1e-3));
  }
}

// Six links: the ground, a bar, and four parallel cranks between them, of which two would do.
TEST(SixBarLinkage, TurnsForAMinuteWithTwiceTheJointsItNeeds) {
  Assembly articulation({.sleeping = false});
  const BodyId bar = articulation.add({.pose = {.position = {1.5, 0, 0}}}, Box{{2.0f, 0.05f, 0.05f}});
  for (int k = 0; k < 4; ++k) {
    const BodyId crank =
        articulation.add({.pose = {.position = {double(k), 0.5, 0}}}, Box{{0.05f, 0.5f, 0.05f}});
    articulation.join(JointKind::hinge, {}, crank, {double(k), 1, 0});
    articulation.join(JointKind::hinge, crank, bar, {double(k), 0, 0});
    articulation.world.set_velocity(crank, {1.5f, 0, 0}, {0, 0, 3});
  }
  articulation.world.set_velocity(bar, {3, 0, 0}, {});
  const double start = articulation.energy();
  const double weight = double(articulation.world.mass_properties(bar).mass) * kGravity;
  double gap = 0.0, tilt = 0.0, change = 0.0, force = 0.0;
  for (int i = 0; i < 3600; ++i) {
    articulation.world.step(kStep);
    gap = std::max(gap, articulation.largest_gap());
    tilt = std::max(tilt, double(std::fabs(2.0f * articulation.world.pose(bar).orientation.z)));
    change = std::max(change, std::fabs(articulation.energy() - start) / weight);
    for (const JointId joint : articulation.joints)
      force = std::max(force, double(length(articulation.world.joint_state(joint).force)));
  }
  EXPECT_TRUE(limit_row("gap of the six-bar (m)", gap, 1e-3, 1e-5));
  EXPECT_TRUE(limit_row("its bar's tilt (rad)", tilt, 1e-3, 1e-5));
  EXPECT_TRUE(limit_row("its energy, of weight times crank", change, 1e-2, 5e-3));
  // Joints that do not need each other must not fight each other: with two cranks none bears more than 1.7 weights.
  EXPECT_TRUE(limit_row("largest force in a joint, weights", force / weight, 2.0, 1.7));
}

// crank 0.3, coupler 0.8, rocker 0.6 on a ground of 0.9 m. Freudenstein: the rocker's angle from the crank's.
TEST(FourBarLinkage, FollowsFreudenstein) {
  const double a = 0.3, b = 0.8, c = 0.6, d = 0.9;
  const auto rocker_angle = [&](double crank) {
    const DVec3 p{a * std::cos(crank), a * std::sin(crank), 0};
    const double x = p.x - d, y = p.y, r = std::sqrt(x * x + y * y);
    return std::atan2(y, x) - std::acos((r * r + c * c - b * b) / (2.0 * r * c));
  };
  const double start = 1.0;
  const DVec3 p{a * std::cos(start), a * std::sin(start), 0};
  const double rocker = rocker_angle(start);
  const DVec3 q{d + c * std::cos(rocker), c * std::sin(rocker), 0};
  Assembly articulation({.gravity = {0, 0, 0}, .sleeping = false});
  const auto link = [&](DVec3 from, DVec3 to) {
    const DVec3 way = to - from;
    const float length_of = float(length(way));
    return articulation.add(
        {.pose = {0.5 * (from + to), from_axis_angle({0, 0, 1}, float(std::atan2(way.y, way.x)))}},
        Box{{0.5f * length_of, 0.02f, 0.02f}});
  };
  const BodyId crank = link({}, p), coupler = link(p, q), swing = link({d, 0, 0}, q);
  const JointId drive = articulation.join(JointKind::hinge, {}, crank, {});
  articulation.join(JointKind::hinge, crank, coupler, p);
  articulation.join(JointKind::hinge, coupler, swing, q);
  articulation.join(JointKind::hinge, swing, {}, {d, 0, 0});
  articulation.world.set_motor(drive, {.target_velocity = 2.0f, .max_force = 1000.0f});
  double worst = 0.0;
  for (int i = 0; i < 1200; ++i) {
    articulation.world.step(kStep);
    const Quat at = articulation.world.pose(crank).orientation,
               end = articulation.world.pose(swing).orientation;
    const double expected = rocker_angle(2.0 * std::atan2(double(at.z), double(at.w)));
    double error = 2.0 * std::atan2(double(end.z), double(end.w)) - expected;
    error -= 2.0 * kPiDouble * std::round(error / (2.0 * kPiDouble));
    worst = std::max(worst, std::fabs(error));
  }
  EXPECT_TRUE(limit_row("A-43 rocker angle (rad)", worst, 1e-2, 1e-4));
  EXPECT_TRUE(relative_row("A-43 speed of the crank", double(articulation.world.angular_velocity(crank).z),
                           2.0, 1e-2, 1e-4));
}

// -------------------------------------------------------------------------------------------------- where it ends

std::uint64_t count_of(const World& world, const std::string& name) {
  StepTimes times;
  read_times(world, times);
  for (const StepCount& count : times.counts) {
    if (name == count.name) return count.value;
  }
  ADD_FAILURE() << "no counter " << name;
  return 0;
}

// A square net hung up at its corners: narrow ones are solved directly, wide ones are swept, and the step says so.
TEST(Net, IsSweptWhereItIsTooDense) {
  for (const int side : {3, 24}) {
    Assembly net({.sleeping = false});
    set_timing(net.world, true);
    for (int k = 0; k < side * side; ++k) net.add({.pose = {.position = {double(k % side), 0, double(k / side)}}}, Sphere{0.4f});
    for (int k = 0; k < side * side; ++k) {
      const DVec3 at{double(k % side), 0, double(k / side)};
      if (k % side + 1 < side) net.join(JointKind::ball, net.bodies[std::size_t(k)], net.bodies[std::size_t(k + 1)], at + DVec3{0.5, 0, 0});
      if (k + side < side * side)
        net.join(JointKind::ball, net.bodies[std::size_t(k)], net.bodies[std::size_t(k + side)], at + DVec3{0, 0, 0.5});
    }
    for (const int k : {0, side - 1, side * (side - 1), side * side - 1})
      net.join(JointKind::ball, {}, net.bodies[std::size_t(k)], {double(k % side), 0, double(k / side)});
    run(net.world, 2.0);
    const std::uint64_t joints = count_of(net.world, "joints");
    EXPECT_EQ(joints, net.joints.size());
    EXPECT_EQ(count_of(net.world, "swept_joints"), side == 3 ? 0u : joints);
    EXPECT_TRUE(limit_row("gap of a net (m)", net.largest_gap(), side == 3 ? 1e-3 : 0.2, 1e-4));
  }
}

// A wheel with more spokes than pairs of joints are listed for.
TEST(Hub, OfManySpokesHolds) {
  for (const int spokes : {6, 60}) {
    Assembly wheel({.gravity = {0, 0, 0}, .sleeping = false});
    set_timing(wheel.world, true);
    const BodyId hub = wheel.add({.angular_velocity = {0, 0, 3}}, Cylinder{0.5f, 0.2f});
    for (int i = 0; i < spokes; ++i) {
      const double a = 2.0 * kPiDouble * i / spokes;
      const DVec3 way{std::cos(a), std::sin(a), 0};
      const BodyId spoke = wheel.add({.pose = {1.5 * way, from_axis_angle({0, 0, 1}, float(a))},
                                      .linear_velocity = {float(-4.5 * way.y), float(4.5 * way.x), 0},
                                      .angular_velocity = {0, 0, 3}},
                                     Box{{0.5f, 0.02f, 0.02f}});
      wheel.join(JointKind::fixed, hub, spoke, way);
    }
    const double spin = wheel.world.momentum().angular.z;
    run(wheel.world, 10.0);
    EXPECT_EQ(count_of(wheel.world, "swept_joints"), spokes == 6 ? 0u : std::uint64_t(spokes));
    EXPECT_TRUE(limit_row("gap of a wheel (m)", wheel.largest_gap(), spokes == 6 ? 1e-4 : 1e-2, 1e-5));
    EXPECT_TRUE(relative_row("spin of a wheel", wheel.world.momentum().angular.z, spin, 1e-3, 1e-5));
  }
}

}  // namespace
}  // namespace gyre::laws::linkage_test
