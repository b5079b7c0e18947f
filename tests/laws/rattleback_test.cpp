// Things that a textbook shows on a table: a rattleback, and a rod whose tip slides where Coulomb's law has no answer.
// Sources: H. Bondi, "The rigid body dynamics of unidirectional spin", 1986; P. Painleve, "Lecons sur le frottement", 1895;
// D. Stewart, "Rigid-body dynamics with friction and impact", 2000.
#include "laws/kit.h"

namespace gyre::laws::rattleback_test {
namespace {

// The underside of an ellipsoid of semi-axes 1, 0.15 (up), 0.2 as a hull whose corners lie close where it rocks.
Geometry rattleback_hull() {
  const double a = 1.0, b = 0.2, c = 0.15;
  std::vector<Vec3> points;
  for (int i = -7; i <= 7; ++i) {
    for (int k = -7; k <= 7; ++k) {
      // By the slopes of the surface, which are those of the floor as the body sees it.
      const double sx = 0.12 * i / 7.0, sz = 0.5 * k / 7.0;
      const double n = std::sqrt(a * a * sx * sx + b * b * sz * sz + c * c);
      points.push_back({float(a * a * sx / n), float(-c * c / n), float(b * b * sz / n)});
    }
  }
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.0 * kPiDouble * i / 12.0;
    points.push_back({float(a * std::cos(angle)), 0, float(b * std::sin(angle))});
  }
  points.push_back({0, float(c), 0});
  return *cook_hull(points);
}

// When the spin of a rattleback first has the other sign; `seconds` if it keeps it.
double reverses_after(double spin, double seconds, float step) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(2.0f));
  BodyDef def{.pose = {.position = {0, 0.15, 0}}};
  def.mass = 1.0f;
  def.center_of_mass = Vec3{};
  // The principal axes are turned against those of the ellipsoid by 10 degrees about the vertical.
  def.inertia = Sym3{0.018290f, 0.208f, 0.198710f, 0, 0.032834f, 0};
  def.angular_velocity = {0.02f, float(spin), 0.02f};
  const BodyId body = world.add_body(def, {.geometry = rattleback_hull(), .material = surface(2.0f)});
  for (int i = 1; i * double(step) < seconds; ++i) {
    world.step(step);
    if (spin * double(world.angular_velocity(body).y) < -0.01) return i * double(step);
  }
  return seconds;
}
// The row's times are those of a smooth surface; here the ellipsoid is a hull of 240 corners, which lets it run down too. What
// counts is the order of events.
TEST(Rattleback, ReversesOneWaySoonAndTheOtherWayLate) {
  for (const float step : {kStep, 1.0f / 240.0f}) {
    const double soon = reverses_after(-2.0, 14.0, step), late = reverses_after(2.0, 14.0, step);
    row("A-25 spin -2 reverses after (s)", soon, 1.18, 1.0, 0.118);
    row("A-25 spin +2 reverses after (s), 13 at least", late, 14.0, 1.0, 1.0);
    EXPECT_LT(soon, 3.0);
    EXPECT_GT(late, 2.0 * soon);
  }
}

// A rod that leans by `angle` from the horizontal while its lower tip slides ahead of it at 5 m/s, with no impact.
struct Slide {
  double energy_gain = 0.0;  // in a step, over the start, while the upper end is in the air
  double max_energy = 0.0;   // over the start
  double largest_impulse = 0.0;
  std::uint64_t hash = 0;
  bool finite = true;
};
Slide slide_rod(double mu, double angle, double side) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(float(mu)));
  const double half = 0.5, radius = 0.01, s = std::sin(angle);
  BodyDef def{.pose = {.position = {0, half * s + radius, 0}}};
  def.pose.orientation = from_axis_angle({0, 0, 1}, float(angle - 0.5 * kPiDouble));
  def.mass = 1.0f;
  def.inertia = Sym3{1.0f / 12.0f, 1e-4f, 1.0f / 12.0f, 0, 0, 0};
  def.linear_velocity = {float(5.0 * side), 0, 0};
  const BodyId rod =
      world.add_body(def, {.geometry = Capsule{float(radius), float(half)}, .material = surface(float(mu))});
  const auto energy = [&] { return world.energy().kinetic + world.energy().potential; };
  const double start = energy();
  double before = start, oldest = start;
  Slide seen;
  std::vector<ContactPoint> points(64);
  for (int i = 0; i < 240; ++i) {
    world.step(kStep);
    // In the step in which an end lands its way ends at the floor, but its speed only in the next step.
    const DVec3 along = turned(world.pose(rod).orientation, {0, 1, 0});
    const double upper = world.pose(rod).position.y + half * std::fabs(along.y);
    if (upper > 0.25)
      seen.energy_gain = std::max(seen.energy_gain, (std::min(energy(), before) - oldest) / start);
    oldest = before;
    before = energy();
    seen.max_energy = std::max(seen.max_energy, before / start);
    double impulse = 0.0;
    for (const ContactPoint& point : std::span(points).first(world.contacts(points)))
      impulse += double(point.normal_impulse);
    seen.largest_impulse = std::max(seen.largest_impulse, impulse);
    seen.finite = seen.finite && std::isfinite(before);
  }
  seen.hash = world.hash();
  return seen;
}
TEST(PainleveRod, NeitherJamsNorGainsEnergy) {
  for (const double mu : {0.5, 1.0, 4.0 / 3.0, 1.6, 2.0, 4.0}) {
    for (const double degrees : {30.0, 58.3, 63.4, 80.0}) {
      for (const double side : {-1.0, 1.0}) {
        const Slide seen = slide_rod(mu, degrees * double(kDegree), side);
        EXPECT_TRUE(seen.finite) << mu << " " << degrees;
        EXPECT_LE(seen.energy_gain, 1e-3) << mu << " " << degrees << " " << side;
        EXPECT_LE(seen.max_energy, 1.0 + 1e-6) << mu << " " << degrees << " " << side;
        // The most that stops a rod of 1 kg: its momentum and that of the fall.
        EXPECT_LE(seen.largest_impulse, 1.0 * (5.0 + std::sqrt(2.0 * kGravity) + kGravity * double(kStep)))
            << mu << " " << degrees << " " << side;
        EXPECT_EQ(seen.hash, slide_rod(mu, degrees * double(kDegree), side).hash);
        if (degrees == 58.3) {
          say("[row] A-28 mu %.3f side %+g: gain %.1e, largest impulse %.3f N s\n", mu, side,
                      seen.energy_gain, seen.largest_impulse);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gyre::laws::rattleback_test
