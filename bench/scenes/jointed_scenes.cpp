#include "bench/scenes/jointed_scenes.h"

#include "bench/scenes/builders.h"

namespace gyre::bench {

static void add_ragdoll(Scene& sc, const Pose& at) {
  const Quat along_x = axis_angle({0, 0, 1}, -kPi / 2);
  auto part = [&](Shape s, V3 p, Quat q = {}) { return add(sc, s, apply(at, p), at.q * q); };
  int pelvis = part(box({0.16, 0.10, 0.10}), {0, 0.95, 0});
  int chest = part(box({0.18, 0.22, 0.11}), {0, 1.30, 0});
  int head = part(sphere(0.12), {0, 1.68, 0});
  int arm[2], fore[2], thigh[2], shin[2], foot[2];
  for (int s = 0; s < 2; ++s) {
    double m = s ? -1 : 1;
    arm[s] = part(capsule(0.05, 0.11), {m * 0.38, 1.46, 0}, along_x);
    fore[s] = part(capsule(0.045, 0.10), {m * 0.705, 1.46, 0}, along_x);
    thigh[s] = part(capsule(0.075, 0.135), {m * 0.10, 0.63, 0});
    shin[s] = part(capsule(0.06, 0.13), {m * 0.10, 0.225, 0});
    foot[s] = part(box({0.05, 0.03, 0.11}), {m * 0.10, 0, 0.05});
  }
  auto joint = [&](JointKind k, int a, int b, V3 anchor, V3 axis, double cone, double lo, double hi) {
    sc.joints.push_back({k, a, b, apply(at, anchor), rot(at.q, axis), cone, lo, hi});
  };
  joint(JointKind::cone, pelvis, chest, {0, 1.065, 0}, {0, 1, 0}, 0.5, -0.4, 0.4);
  joint(JointKind::cone, chest, head, {0, 1.54, 0}, {0, 1, 0}, 0.6, -0.7, 0.7);
  for (int s = 0; s < 2; ++s) {
    double m = s ? -1 : 1;
    joint(JointKind::cone, chest, arm[s], {m * 0.22, 1.46, 0}, {m, 0, 0}, 1.2, -0.8, 0.8);
    joint(JointKind::hinge, arm[s], fore[s], {m * 0.55, 1.46, 0}, {0, -m, 0}, 0, 0.0, 2.3);
    joint(JointKind::cone, pelvis, thigh[s], {m * 0.10, 0.845, 0}, {0, -1, 0}, 1.0, -0.4, 0.4);
    joint(JointKind::hinge, thigh[s], shin[s], {m * 0.10, 0.418, 0}, {1, 0, 0}, 0, 0.0, 2.3);
    joint(JointKind::hinge, shin[s], foot[s], {m * 0.10, 0.032, 0}, {1, 0, 0}, 0, -0.6, 0.6);
  }
}

Scene ragdolls() {
  Scene sc;
  sc.steps = 400;
  ground(sc, 60);
  Lcg g(7);
  for (int i = 0; i < 200; ++i) {
    int l = i / 25, r = i % 25;
    Quat q = axis_angle({0, 1, 0}, g.range(-kPi, kPi)) * axis_angle({1, 0, 0}, g.range(-0.5, 0.5));
    add_ragdoll(sc, {{(r % 5 - 2) * 2.2, 0.8 + 2.3 * l, (r / 5 - 2) * 2.2}, q});
  }
  return sc;
}

Scene joint_grid() {
  Scene sc;
  sc.steps = 300;
  const int n = 50;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      bool fixed = (i == 0 || i == n - 1) && (j == 0 || j == n - 1);
      int b = add(sc, sphere(0.4), {i - 0.5 * (n - 1), 0, j - 0.5 * (n - 1)}, {},
                  fixed ? Motion::fixed : Motion::dynamic);
      if (!fixed) sc.bodies[b].layer = Layer::no_self;
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      int a = j * n + i;
      if (i + 1 < n)
        sc.joints.push_back(
            {JointKind::ball, a, a + 1, 0.5 * (sc.bodies[a].pos + sc.bodies[a + 1].pos), {0, 1, 0}, 0, 0, 0});
      if (j + 1 < n)
        sc.joints.push_back(
            {JointKind::ball, a, a + n, 0.5 * (sc.bodies[a].pos + sc.bodies[a + n].pos), {0, 1, 0}, 0, 0, 0});
    }
  return sc;
}

// 100 capsules and a ball of 100 times a link's mass; hanging at rest or let go from the horizontal.
Scene chain(bool swing) {
  Scene sc;
  sc.steps = 600;
  const double pitch = 0.5, r = 0.1, hl = 0.15;
  V3 dir = swing ? V3{1, 0, 0} : V3{0, -1, 0};
  Quat q = swing ? axis_angle({0, 0, 1}, -kPi / 2) : Quat{};
  V3 root{0, 60, 0};
  int prev = add(sc, sphere(0.1), root, {}, Motion::fixed);
  for (int i = 0; i < 100; ++i) {
    int b = add(sc, capsule(r, hl), root + ((i + 0.5) * pitch) * dir, q);
    sc.bodies[b].layer = Layer::no_self;
    sc.joints.push_back({JointKind::ball, prev, b, root + (i * pitch) * dir, {0, 1, 0}, 0, 0, 0});
    prev = b;
  }
  double link = 1000 * (kPi * r * r * 2 * hl + 4.0 / 3 * kPi * r * r * r);
  const double R = 0.8;
  int ball = add(sc, sphere(R), root + (100 * pitch + R) * dir, {}, Motion::dynamic,
                 100 * link / (4.0 / 3 * kPi * R * R * R));
  sc.bodies[ball].layer = Layer::no_self;
  sc.joints.push_back({JointKind::ball, prev, ball, root + (100 * pitch) * dir, {0, 1, 0}, 0, 0, 0});
  sc.chain_end = ball;
  sc.chain_root = root;
  sc.chain_length = 100 * pitch + R;
  return sc;
}

}  // namespace gyre::bench
