#include "bench/scenes/contact_trials.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/scenes/builders.h"
#include "bench/scenes/clock.h"

namespace gyre::bench {
namespace {

using States = std::vector<BodyState>;
using Traces = std::vector<BodyTrace>;

constexpr int kDraws = 200, kLanes = 20, kTileSteps = 150;
constexpr double kSpacing = 10.0;  // m between lanes

double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

// A ball flies over the edge of a fixed box with air of 2 to 10 % of its radius between them; nothing else acts on it.
Scene near_miss() {
  Scene sc;
  sc.gravity = 0;
  Lcg random(1);
  for (int i = 0; i < kDraws; ++i) {
    const double radius = random.range(0.1, 0.4), air = radius * random.range(0.02, 0.1),
                 speed = random.range(2.0, 30.0), z = kSpacing * i;
    add(sc, box({0.15, 0.15, 1}), {0, -0.15, z}, {}, Motion::fixed);
    const int ball = add(sc, sphere(radius), {-1.0 - speed * kDt * random.next(), radius + air, z});
    sc.bodies[std::size_t(ball)].vel = {speed, 0, 0};
  }
  return sc;
}
std::vector<Figure> judge_near_miss(const Scene& sc, const Traces& traces, const States&, const States&) {
  std::vector<double> changes;
  for (const BodyTrace& trace : traces) {
    const V3 before = sc.bodies[std::size_t(trace.body)].vel;
    changes.push_back(len(trace.last.velocity - before) / len(before));
  }
  const auto deflected = std::count_if(changes.begin(), changes.end(), [](double c) { return c > 1e-3; });
  return {{"deflected_of_200", double(deflected)}, {"worst_change_of_velocity", largest(changes)}};
}

// A ball strikes one of the same size off its centre, without friction and with restitution 1.
Scene cut_shot() {
  Scene sc;
  sc.gravity = 0;
  sc.friction = 0;
  sc.restitution = 1;
  Lcg random(2);
  for (int i = 0; i < kDraws; ++i) {
    const double radius = 0.0285, speed = random.range(2.0, 6.0),
                 offset = 2 * radius * random.range(0.2, 0.8), z = kSpacing * i;
    const int cue = add(sc, sphere(radius), {-0.5 - speed * kDt * random.next(), offset, z});
    sc.bodies[std::size_t(cue)].vel = {speed, 0, 0};
    add(sc, sphere(radius), {0, 0, z});
  }
  return sc;
}
std::vector<Figure> judge_cut_shot(const Scene& sc, const Traces& traces, const States&, const States&) {
  std::vector<double> angles, gains, losses;
  for (std::size_t i = 0; i + 1 < traces.size(); i += 2) {
    const Body& cue = sc.bodies[std::size_t(traces[i].body)];
    const double sine = cue.pos.y / (2 * cue.shapes[0].radius);
    const V3 line{std::sqrt(1 - sine * sine), -sine, 0}, struck = traces[i + 1].last.velocity;
    const double cosine = len(struck) > 0 ? dot(unit(struck), line) : -1.0;
    angles.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / kPi);
    const double energy =
        (dot(struck, struck) + dot(traces[i].last.velocity, traces[i].last.velocity)) / dot(cue.vel, cue.vel);
    gains.push_back(100.0 * (energy - 1.0));
    losses.push_back(100.0 * (1.0 - energy));
  }
  return {{"median_error_deg", quantile(angles, 0.5)},
          {"worst_error_deg", largest(angles)},
          {"most_energy_gained_pct", largest(gains)},
          {"most_energy_lost_pct", largest(losses)}};
}

// Balls of 1 cm with restitution 1 fall on a floor and bounce for 20 seconds.
Scene small_bounce() {
  Scene sc;
  sc.friction = 0;
  sc.restitution = 1;
  Lcg random(3);
  ground(sc, 200);
  for (int i = 0; i < kLanes; ++i)
    add(sc, sphere(0.005), {0, 0.005 + random.range(0.1, 1.0), kSpacing * (i - kLanes / 2)});
  return sc;
}
std::vector<Figure> judge_small_bounce(const Scene& sc, const Traces& traces, const States&, const States&) {
  std::vector<double> gains, losses;
  for (const BodyTrace& trace : traces) {
    const double radius = sc.bodies[std::size_t(trace.body)].shapes[0].radius;
    const double before = -sc.gravity * (sc.bodies[std::size_t(trace.body)].pos.y - radius);
    const double now =
        -sc.gravity * (trace.last.pose.p.y - radius) + 0.5 * dot(trace.last.velocity, trace.last.velocity);
    gains.push_back(100.0 * (now / before - 1.0));
    losses.push_back(100.0 * (1.0 - now / before));
  }
  return {{"most_energy_gained_pct", largest(gains)}, {"most_energy_lost_pct", largest(losses)}};
}

// Boxes turned about the vertical slide without friction over flush cubes of 1 m.
Scene tiles() {
  Scene sc;
  sc.friction = 0;
  Lcg random(4);
  for (int i = 0; i < kLanes; ++i) {
    const double z = kSpacing * i;
    for (int x = 0; x < 24; ++x) {
      for (int k = -1; k <= 1; ++k)
        add(sc, box({0.5, 0.5, 0.5}), {double(x), -0.5, z + double(k)}, {}, Motion::fixed);
    }
    const int slider = add(sc, box({0.3, 0.1, 0.2}), {0.2 * random.next(), 0.1, z + random.range(-0.4, 0.4)},
                           axis_angle({0, 1, 0}, random.range(0, 2 * kPi)));
    sc.bodies[std::size_t(slider)].vel = {random.range(2.0, 8.0), 0, 0};
  }
  return sc;
}
std::vector<Figure> judge_tiles(const Scene& sc, const Traces& traces, const States&, const States&) {
  std::vector<double> bumps, changes, lags;
  for (const BodyTrace& trace : traces) {
    const Body& body = sc.bodies[std::size_t(trace.body)];
    const V3 free_path = kTileSteps * kDt * body.vel;
    bumps.push_back(1000.0 * (trace.highest - body.pos.y));
    changes.push_back(100.0 * len(trace.last.velocity - body.vel) / len(body.vel));
    lags.push_back(100.0 * len(trace.last.pose.p - body.pos - free_path) / len(free_path));
  }
  return {{"worst_bump_mm", largest(bumps)},
          {"worst_change_of_velocity_pct", largest(changes)},
          {"worst_lag_pct_of_the_path", largest(lags)}};
}

// Boxes on kinematic tables that turn, as fast as takes 30 % of the grip.
Scene turntable() {
  Scene sc;
  sc.friction = 0.5;
  Lcg random(5);
  for (int i = 0; i < kLanes; ++i) {
    const double radius = random.range(0.3, 2.5), rate = std::sqrt(0.3 * sc.friction * -sc.gravity / radius),
                 z = kSpacing * i;
    const int table = add(sc, box({3, 0.2, 3}), {0, -0.2, z}, {}, Motion::kinematic);
    sc.bodies[std::size_t(table)].ang = {0, rate, 0};
    const int rider = add(sc, box({0.1, 0.1, 0.1}), {radius, 0.1, z});
    sc.bodies[std::size_t(rider)].vel = {0, 0, -rate * radius};
    sc.bodies[std::size_t(rider)].ang = {0, rate, 0};
  }
  return sc;
}

// Stacks of five boxes on the floor of a station that turns, and so has 1 g at its rim; there is no other gravity.
Scene station() {
  Scene sc;
  sc.gravity = 0;
  Lcg random(6);
  for (int i = 0; i < kLanes; ++i) {
    const double radius = 10.0 * std::pow(10.0, random.next()), rate = std::sqrt(-kGravity / radius),
                 z = kSpacing * i;
    Shape floor = box({2, 0.5, 2});
    floor.local.p = {0, -radius - 0.5, 0};
    const int wheel = add(sc, floor, {0, 0, z}, {}, Motion::kinematic);
    sc.bodies[std::size_t(wheel)].ang = {0, 0, rate};
    for (int k = 0; k < 5; ++k) {
      const double height = 0.1 + 0.2 * k;
      const int block = add(sc, box({0.1, 0.1, 0.1}), {0, -radius + height, z});
      sc.bodies[std::size_t(block)].vel = {rate * (radius - height), 0, 0};
      sc.bodies[std::size_t(block)].ang = {0, 0, rate};
    }
  }
  return sc;
}

// How far the riders moved in the frame of the last kinematic body before each, m.
std::vector<double> slips(const Scene& sc, const States& first, const States& last) {
  std::vector<double> out;
  std::size_t carrier = 0;
  for (std::size_t i = 0; i < sc.bodies.size(); ++i) {
    if (sc.bodies[i].motion == Motion::kinematic) {
      carrier = i;
      continue;
    }
    out.push_back(len(apply_inverse(last[carrier].pose, last[i].pose.p) -
                      apply_inverse(first[carrier].pose, first[i].pose.p)));
  }
  return out;
}
std::vector<Figure> judge_carried(const Scene& sc, const Traces&, const States& first, const States& last) {
  const std::vector<double> all = slips(sc, first, last);
  return {{"median_slip_mm", 1000.0 * quantile(all, 0.5)}, {"worst_slip_mm", 1000.0 * largest(all)}};
}

States states_of(Engine& engine, const Scene& scene) {
  States out;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) out.push_back(engine.state(int(i)));
  return out;
}

}  // namespace

const std::vector<ContactTrial>& contact_trials() {
  static const std::vector<ContactTrial> trials = {
      {"near_miss", 90, near_miss, judge_near_miss},
      {"cut_shot", 60, cut_shot, judge_cut_shot},
      {"small_bounce", 1200, small_bounce, judge_small_bounce},
      {"tiles", kTileSteps, tiles, judge_tiles},
      {"turntable", 600, turntable, judge_carried},
      {"station", 600, station, judge_carried},
  };
  return trials;
}

std::optional<std::vector<Figure>> find_figures(Engine& engine, const ContactTrial& trial) {
  const Scene scene = trial.make();
  std::string why_not;
  if (!engine.create(scene, 1, false, why_not)) {
    std::fprintf(stderr, "%s: %s\n", engine.name(), why_not.c_str());
    return {};
  }
  const States first = states_of(engine, scene);
  Traces traces;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].motion == Motion::dynamic)
      traces.push_back({int(i), scene.bodies[i].pos.y, first[i]});
  }
  for (int k = 0; k < trial.steps; ++k) {
    engine.step();
    for (BodyTrace& trace : traces) {
      trace.last = engine.state(trace.body);
      trace.highest = std::max(trace.highest, trace.last.pose.p.y);
    }
  }
  return trial.judge(scene, traces, first, states_of(engine, scene));
}

int run_trial(Engine& engine, const std::string& name) {
  for (const ContactTrial& trial : contact_trials()) {
    if (name != trial.name) continue;
    const std::optional<std::vector<Figure>> figures = find_figures(engine, trial);
    if (!figures) return 1;
    std::printf("{\"engine\":\"%s\",\"trial\":\"%s\"", engine.name(), trial.name);
    for (const Figure& figure : *figures) std::printf(",\"%s\":%.6g", figure.name, figure.value);
    std::printf("}\n");
    return 0;
  }
  std::fprintf(stderr, "no trial %s; there are:", name.c_str());
  for (const ContactTrial& trial : contact_trials()) std::fprintf(stderr, " %s", trial.name);
  std::fprintf(stderr, "\n");
  return 2;
}

}  // namespace gyre::bench
