// The rotation kernels against the same rotations computed one body at a time, to the bit, at every width.
#include "math/rotation.h"
#include "random.h"
#include "solver/kernels/solver_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gyre::rotation_kernel_test {
namespace {

struct Random : testing_random::MixedSingles {
  Random() : MixedSingles{{0x2545f4914f6cdd1du}} {}
};

struct Spinner {
  BodyMotion motion;
  Quat orientation;
  Sym3 inertia;
};

// A symmetric tensor in double.
struct Tensor {
  double xx, yy, zz, xy, xz, yz;

  DVec3 operator*(DVec3 v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};
Tensor inverse_of(const Tensor& m) {
  const double cxx = m.yy * m.zz - m.yz * m.yz, cxy = m.xz * m.yz - m.xy * m.zz,
               cxz = m.xy * m.yz - m.xz * m.yy;
  const double s = 1.0 / (m.xx * cxx + m.xy * cxy + m.xz * cxz);
  return {s * cxx, s * (m.xx * m.zz - m.xz * m.xz), s * (m.xx * m.yy - m.xy * m.xy), s * cxy,
          s * cxz, s * (m.xy * m.xz - m.xx * m.yz)};
}

DQuat sum(DQuat a, DQuat b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
DQuat times(double s, DQuat q) { return {s * q.x, s * q.y, s * q.z, s * q.w}; }

DQuat rotate_in_steps(DQuat q, DVec3 momentum, const Tensor& inverse, double seconds, double angle) {
  const int steps = 1 + int(std::fmin(angle / 0.02, 4096.0));
  const double h = seconds / double(steps);
  const auto rate = [&](DQuat at) {
    const DVec3 w = inverse * rotate_inverse(at, momentum);
    return times(0.5, at * DQuat{w.x, w.y, w.z, 0.0});
  };
  for (int i = 0; i < steps; ++i) {
    const DQuat k1 = rate(q), k2 = rate(normalized(sum(q, times(0.5 * h, k1))));
    const DQuat k3 = rate(normalized(sum(q, times(0.5 * h, k2)))),
                k4 = rate(normalized(sum(q, times(h, k3))));
    q = normalized(sum(q, times(h / 6.0, sum(sum(k1, times(2.0, sum(k2, k3))), k4))));
  }
  return q;
}

// 0, 1, 2: the axis of revolution; 3: none.
int axis_of_revolution(const Sym3& m) {
  if (m.xy != 0.0f || m.xz != 0.0f || m.yz != 0.0f) return 3;
  const float moments[3] = {m.xx, m.yy, m.zz};
  for (int k = 0; k < 3; ++k) {
    const float a = moments[(k + 1) % 3], b = moments[(k + 2) % 3];
    if (std::fabs(a - b) <= 1.0e-6f * a) return k;
  }
  return 3;
}

DQuat rotate_symmetric_top(DQuat start, DVec3 momentum, const Sym3& inertia, int axis, double seconds) {
  const float moments[3] = {inertia.xx, inertia.yy, inertia.zz};
  const double along = double(moments[axis]),
               across = 0.5 * (double(moments[(axis + 1) % 3]) + double(moments[(axis + 2) % 3]));
  const double spin = rotate_inverse(start, momentum)[axis] * (1.0 / along - 1.0 / across);
  const DVec3 own{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
  return normalized(exponential_map((seconds / across) * momentum) * start *
                    exponential_map((seconds * spin) * own));
}

void rotate_plainly(Spinner& body, float seconds) {
  Vec3& spin = body.motion.angular_velocity;
  const Vec3 w = rotate_inverse(body.orientation, spin), own_momentum = body.inertia * w;
  const float angle = seconds * length(spin);
  if (angle < 1.0e-6f || length_squared(cross(own_momentum, w)) <=
                             square(1.0e-7f) * length_squared(own_momentum) * length_squared(w)) {
    const Vec3 turn = seconds * spin;
    if (turn != Vec3{}) body.orientation = integrate_rotation(body.orientation, turn);
    body.motion.delta_rotation += turn;
    return;
  }
  const Sym3& m = body.inertia;
  const Tensor tensor{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}, inverse = inverse_of(tensor);
  const DQuat start = normalized(to_double(body.orientation));
  const DVec3 velocity = rotate_inverse(start, DVec3(spin)), own = tensor * velocity;
  const DVec3 momentum = rotate(start, own);
  const double time = double(seconds);
  const int axis = axis_of_revolution(m);
  DQuat q;
  if (axis < 3) {
    q = rotate_symmetric_top(start, momentum, m, axis, time);
  } else if (angle < 2.0e-3f) {
    const DVec3 middle = velocity + 0.5 * time * (inverse * cross(own, velocity));
    q = normalized(start * exponential_map(time * middle));
  } else {
    q = rotate_in_steps(start, momentum, inverse, time, double(angle));
  }
  spin = to_float(rotate(q, inverse * rotate_inverse(q, momentum)));
  body.orientation = to_float(q);
  body.motion.delta_rotation += to_float(logarithm_map(q * conjugate(start)));
}

// Of all sizes, from rest to very fast; with and without an axis of revolution.
Spinner make_spinner(Random& random) {
  Spinner body;
  body.orientation = normalized(
      Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
  body.motion.delta_rotation = random.vector(0.1f);
  const float size = std::pow(10.0f, random.between(-6.0f, 2.5f));
  if (random.between(0, 1) > 0.05f) body.motion.angular_velocity = random.vector(size);
  float moments[3] = {random.between(1, 2), random.between(1, 2), random.between(1, 2)};
  const int kind = int(random.between(0, 5.99f));
  if (kind < 3) moments[kind] = moments[(kind + 1) % 3];
  if (kind == 3) moments[0] = moments[1] = moments[2];
  body.inertia = {.xx = moments[0], .yy = moments[1], .zz = moments[2]};
  if (kind == 4) body.inertia.xy = 0.1f, body.inertia.yz = -0.05f;
  return body;
}

void expect_same(const Spinner& body, const Spinner& plain, int width) {
  const Quat &q = body.orientation, &p = plain.orientation;
  EXPECT_TRUE(q.x == p.x && q.y == p.y && q.z == p.z && q.w == p.w) << "width " << width;
  EXPECT_EQ(body.motion.angular_velocity, plain.motion.angular_velocity) << "width " << width;
  EXPECT_EQ(body.motion.delta_rotation, plain.motion.delta_rotation) << "width " << width;
}

TEST(RotationKernel, RotatesManyBodiesAsSingleOnes) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    const float seconds = round % 2 == 0 ? 1.0f / 60.0f : 1.0f / 480.0f;
    std::vector<Spinner> bodies;
    for (int i = 0; i <= round % kMaxRotations; ++i) bodies.push_back(make_spinner(random));
    std::vector<Spinner> plain = bodies;
    for (Spinner& body : plain) rotate_plainly(body, seconds);
    for (const int width : {0, 1, 4, 8, 16}) {
      std::vector<Spinner> turned = bodies;
      TorqueFreeRotation rotations[kMaxRotations];
      for (std::size_t i = 0; i < turned.size(); ++i)
        rotations[i] = {&turned[i].motion, &turned[i].orientation, &turned[i].inertia};
      select_kernels(width).rotation.rotate_torque_free(rotations, int(turned.size()), seconds);
      for (std::size_t i = 0; i < turned.size(); ++i) expect_same(turned[i], plain[i], width);
    }
  }
}

TEST(RotationKernel, RotatesByVectorsAsSingleOnes) {
  Random random;
  for (int count = 0; count <= kMaxRotations; ++count) {
    std::vector<ConstantRotation> rotations;
    for (int i = 0; i < count; ++i) {
      const Spinner body = make_spinner(random);
      rotations.push_back({body.orientation, 0.1f * body.motion.angular_velocity});
    }
    for (const int width : {0, 1, 4, 8, 16}) {
      std::vector<ConstantRotation> turned = rotations;
      select_kernels(width).rotation.rotate_at_constant_velocity(turned.data(), count);
      for (std::size_t i = 0; i < rotations.size(); ++i)
        EXPECT_EQ(turned[i].orientation, integrate_rotation(rotations[i].orientation, rotations[i].rotation))
            << width;
    }
  }
}

}  // namespace
}  // namespace gyre::rotation_kernel_test
