// What the tests of physical laws share: worlds and bodies in one line, and the row of a table of expectations.
//
// A row compares a measured number with its exact value. "Good" is the tolerance that is asserted; "top" is the goal, whose
// outcome is printed only.
#pragma once

#include <gtest/gtest.h>

#include <gyre/gyre.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace gyre::laws {

constexpr float kStep = 1.0f / 60.0f;
constexpr double kGravity = 9.81;
constexpr float kDegree = kPi / 180.0f;

// Which parts of the engine worlds use where a test does not say: `gyre validate` runs laws with each that they are about.
struct Choice {
  IntegratorKind integrator = Stepping{}.integrator;
  SolverKind solver = Stepping{}.solver;
};
inline Choice& choice() {
  static Choice chosen;
  return chosen;
}

// Which parts the world has that was made last: that is what rows are about.
inline Choice& in_use() {
  static Choice used;
  return used;
}

inline World make_world(WorldDef def = {}) {
  if (def.stepping.integrator == Stepping{}.integrator) def.stepping.integrator = choice().integrator;
  if (def.stepping.solver == Stepping{}.solver) def.stepping.solver = choice().solver;
  in_use() = {def.stepping.integrator, def.stepping.solver};
  Result<World> made = World::create(def);
  if (!made) std::fprintf(stderr, "%s\n", made.error().message);
  return std::move(*made);
}
inline World weightless() { return make_world({.gravity = {0, 0, 0}}); }

inline Material surface(float friction, float restitution = 0.0f) {
  return {.static_friction = friction, .dynamic_friction = friction, .restitution = restitution};
}

inline BodyId add_ground(World& world, const Material& material = {}) {
  return world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = material});
}

// A body that touches nothing, of the given mass and principal moments.
inline BodyDef point_body(double mass, Vec3 moments, DVec3 place = {}) {
  BodyDef def;
  def.pose.position = place;
  def.mass = float(mass);
  def.center_of_mass = Vec3{};
  def.inertia = Sym3{moments.x, moments.y, moments.z, 0, 0, 0};
  return def;
}

inline void run(World& world, double seconds, float step = kStep) {
  const int steps = int(std::lround(seconds / double(step)));
  for (int i = 0; i < steps; ++i) world.step(step);
}

inline DVec3 wide(Vec3 v) { return DVec3(v); }
inline DVec3 turned(Quat q, DVec3 v) {
  const DVec3 u{double(q.x), double(q.y), double(q.z)};
  const DVec3 t = 2.0 * cross(u, v);
  return v + double(q.w) * t + cross(u, t);
}
inline DVec3 turned_back(Quat q, DVec3 v) { return turned(conjugate(q), v); }

// What a row says, kept for who asks for it.
struct Row {
  std::string name;
  double measured = 0.0, expected = 0.0;
  double good = 0.0, top = 0.0;   // greatest error, or greatest value of a limit
  bool is_limit = false;          // at most `good`; nothing is expected
  bool met = false, met_top = false;
  Choice parts;
};
struct Rows {
  bool printed = true;  // on standard output, one a line
  std::vector<Row> list;
};
inline Rows& rows() {
  static Rows all;
  return all;
}
// Prints as printf() does, if rows are printed.
template <class... Arguments>
void say(const char* format, Arguments... arguments) {
  if (rows().printed) std::printf(format, arguments...);
}

// Measured against expected, within `good` (absolute), and whether it is within `top` too.
inline bool row(const char* name, double measured, double expected, double good, double top) {
  const double error = std::fabs(measured - expected);
  rows().list.push_back({name, measured, expected, good, top, false, error <= good, error <= top, in_use()});
  say("[row] %-44s %14.7g expected %12.7g  error %9.2e  good %8.1e %s  top %8.1e %s\n", name, measured, expected, error,
      good, error <= good ? "met" : "FAIL", top, error <= top ? "met" : "no");
  return error <= good;
}
inline bool relative_row(const char* name, double measured, double expected, double good, double top) {
  return row(name, measured, expected, good * std::fabs(expected), top * std::fabs(expected));
}
// A number that must stay at or below `good`.
inline bool limit_row(const char* name, double measured, double good, double top) {
  rows().list.push_back({name, measured, 0.0, good, top, true, measured <= good, measured <= top, in_use()});
  say("[row] %-44s %14.7g at most  %12.7g  %s  top %8.1e %s\n", name, measured, good, measured <= good ? "met" : "FAIL",
      top, measured <= top ? "met" : "no");
  return measured <= good;
}

// Times at which a sampled signal passes zero upwards, by linear interpolation.
class ZeroCrossings {
 public:
  void add(double time, double value) {
    if (any_ && last_ < 0.0 && value >= 0.0)
      times_.push_back(last_time_ + (time - last_time_) * (-last_ / (value - last_)));
    any_ = true;
    last_ = value;
    last_time_ = time;
  }
  int count() const { return int(times_.size()); }
  double time(int i) const { return times_[std::size_t(i)]; }
  double mean_period() const { return (times_.back() - times_.front()) / double(times_.size() - 1); }

 private:
  std::vector<double> times_;
  bool any_ = false;
  double last_ = 0.0, last_time_ = 0.0;
};

// An angle known modulo a turn, followed continuously.
class Unwrapped {
 public:
  void add(double angle) {
    if (any_) {
      double d = angle - last_;
      d -= 2.0 * kPiDouble * std::round(d / (2.0 * kPiDouble));
      sum_ += d;
    }
    any_ = true;
    last_ = angle;
  }
  double turned() const { return sum_; }

 private:
  bool any_ = false;
  double last_ = 0.0, sum_ = 0.0;
};

}  // namespace gyre::laws
