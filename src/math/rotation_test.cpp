// Round trips between all forms of a rotation, over random and degenerate ones; rotated inertia; the double twins.
#include "math/rotation.h"

#include "random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "math/trig.h"

namespace gyre::rotation_test {
namespace {

struct Random : testing_random::Mixed {
  Random() : Mixed{0x2545f4914f6cdd1du} {}
  float between(double low, double high) { return float(Mixed::between(low, high)); }
  Vec3 vector() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  Quat rotation() {
    for (;;) {
      const Quat q{between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)};
      const float n = dot(q, q);
      if (n < 1.0f && n > 0.01f) return normalized(q);
    }
  }
};

// Random rotations, and those at which formulas tend to fail.
std::vector<Quat> rotations() {
  std::vector<Quat> list;
  Random random;
  for (int i = 0; i < 500; ++i) list.push_back(random.rotation());
  const float r = 0.70710678f;
  const float values[] = {0.0f, 1.0f, -1.0f, r, -r, 0.5f, -0.5f, 1.0e-4f, -1.0e-8f};
  for (const float x : values) {
    for (const float y : values) {
      for (const float z : values) {
        for (const float w : values) {
          const float n = x * x + y * y + z * z + w * w;
          if (n > 0.9f && n < 1.1f) list.push_back(normalized(Quat{x, y, z, w}));
        }
      }
    }
  }
  return list;
}

// The angle between two rotations, rad.
double apart(Quat a, Quat b) {
  const DQuat between = to_double(b) * conjugate(to_double(a));
  return length(logarithm_map(between));
}

double distance(const Mat3& a, const Mat3& b) {
  const Mat3 d = a - b;
  return std::sqrt(double(length_squared(d.x)) + double(length_squared(d.y)) + double(length_squared(d.z)));
}

TEST(Rotation, MatrixRoundTrip) {
  for (const Quat q : rotations()) {
    const Mat3 m = to_matrix(q);
    EXPECT_NEAR(determinant(m), 1.0f, 1.0e-6f);
    const Quat back = from_matrix(m);
    EXPECT_LT(apart(q, back), 5.0e-7) << q.x << ' ' << q.y << ' ' << q.z << ' ' << q.w;
    EXPECT_NEAR(dot(back, back), 1.0f, 3.0e-7f);
  }
}

TEST(Rotation, MatrixRotatesLikeQuaternion) {
  Random random;
  for (const Quat q : rotations()) {
    const Vec3 v = random.vector();
    EXPECT_LT(gyre::distance(to_matrix(q) * v, rotate(q, v)), 1.0e-6f);
    EXPECT_LT(gyre::distance(rotate_inverse(q, rotate(q, v)), v), 2.0e-6f);
  }
}

TEST(Rotation, RotationVectorRoundTrip) {
  for (const Quat q : rotations()) {
    const Vec3 v = to_rotation_vector(q);
    EXPECT_LE(length(v), kPi * 1.000001f);
    EXPECT_LT(apart(q, from_rotation_vector(v)), 4.0e-7);
  }
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 v = random.between(0, 1.8) * random.vector();  // length below pi
    EXPECT_LT(gyre::distance(to_rotation_vector(from_rotation_vector(v)), v), 1.0e-6f);
  }
}

TEST(Rotation, TinyRotationVectorsKeepTheirDigits) {
  for (const float size : {1.0e-3f, 1.0e-8f, 1.0e-20f, 1.0e-37f}) {
    const Vec3 v{size, -2.0f * size, 0.5f * size};
    const Vec3 back = to_rotation_vector(from_rotation_vector(v));
    EXPECT_FLOAT_EQ(back.x, v.x);
    EXPECT_FLOAT_EQ(back.y, v.y);
    EXPECT_FLOAT_EQ(back.z, v.z);
  }
  EXPECT_EQ(from_rotation_vector({0, 0, 0}), Quat{});
  EXPECT_EQ(to_rotation_vector(Quat{}), Vec3{});
  EXPECT_EQ(to_rotation_vector({0, 0, 0, -1}), Vec3{});
}

TEST(Rotation, ExponentialIsSmoothWhereItsFormulaChanges) {
  // The series ends at rotation vectors of length 1.
  const DQuat below = exponential_map({1.0 - 1.0e-13, 0, 0}), above = exponential_map({1.0 + 1.0e-13, 0, 0});
  EXPECT_NEAR(below.x, above.x, 2.0e-13);
  EXPECT_NEAR(below.w, above.w, 2.0e-13);
  EXPECT_NEAR(above.x, std::sin(0.5), 2.0e-13);
}

TEST(Rotation, AxisAngle) {
  const Quat quarter = from_axis_angle({0, 0, 7.0f}, 0.5f * kPi);
  EXPECT_LT(gyre::distance(rotate(quarter, Vec3{1, 0, 0}), Vec3{0, 1, 0}), 1.0e-6f);
  EXPECT_EQ(from_axis_angle({0, 0, 0}, 1.0f), Quat{});
  // Neither tiny nor huge axes lose their direction.
  for (const float size : {1.0e-38f, 1.0e-20f, 1.0e20f, 3.0e38f}) {
    EXPECT_LT(apart(from_axis_angle({0, size, 0}, 1.0f), from_axis_angle({0, 1, 0}, 1.0f)), 2.0e-7);
  }
  // One full revolution is the other quaternion of the identity.
  EXPECT_NEAR(from_axis_angle({1, 0, 0}, 2.0f * kPi).w, -1.0f, 1.0e-6f);
}

TEST(Rotation, NotANumberStaysVisible) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(is_finite(from_axis_angle({nan, 0, 0}, 1.0f)));
  EXPECT_FALSE(is_finite(from_axis_angle({1, 0, 0}, nan)));
  EXPECT_FALSE(is_finite(from_rotation_vector({0, nan, 0})));
  EXPECT_FALSE(is_finite(to_rotation_vector({0, nan, 0, 1})));
  EXPECT_FALSE(is_finite(integrate_rotation({}, {nan, 0, 0})));
  EXPECT_FALSE(is_finite(from_rotation_vector({std::numeric_limits<float>::infinity(), 0, 0})));
}

TEST(Rotation, FromDirections) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = normalized(random.vector());
    Vec3 b = normalized(random.vector());
    // Also almost equal and almost opposite directions.
    const float tiny = std::pow(10.0f, -random.between(1, 8));
    if (i % 3 == 1) b = normalized(a + tiny * b);
    if (i % 3 == 2) b = normalized(tiny * b - a);
    const Quat q = from_directions(a, b);
    EXPECT_LT(gyre::distance(rotate(q, a), b), 1.0e-6f);
    // The shortest rotation: its axis is at a right angle to both.
    EXPECT_NEAR(dot(Vec3{q.x, q.y, q.z}, a), 0.0f, 3.0e-7f);
  }
  const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  for (const Vec3 a : axes) {
    EXPECT_EQ(from_directions(a, a), Quat{});
    EXPECT_EQ(rotate(from_directions(a, -a), a), -a);
  }
  EXPECT_EQ(from_directions({0, 0, 0}, {1, 0, 0}), Quat{});
}

TEST(Rotation, SlerpEndsAndMiddle) {
  const std::vector<Quat> list = rotations();
  for (std::size_t i = 0; i + 1 < list.size(); ++i) {
    const Quat a = list[i], b = list[i + 1];
    EXPECT_EQ(slerp(a, b, 0.0f), a);
    const Quat end = slerp(a, b, 1.0f);
    EXPECT_TRUE(end == b || end == -b);
    const double whole = apart(a, b);
    const Quat third = slerp(a, b, 0.3f);
    EXPECT_NEAR(apart(a, third), 0.3 * whole, 1.0e-6);
    EXPECT_NEAR(apart(third, b), 0.7 * whole, 1.0e-6);
    EXPECT_NEAR(dot(third, third), 1.0f, 5.0e-7f);
  }
  const Quat q = list[0];
  EXPECT_EQ(slerp(q, q, 0.5f), q);
  EXPECT_EQ(slerp(q, -q, 0.5f), q);
}

constexpr EulerOrder kOrders[] = {EulerOrder::xyz, EulerOrder::xzy, EulerOrder::yxz,
                                  EulerOrder::yzx, EulerOrder::zxy, EulerOrder::zyx};
constexpr int kAxes[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

Quat about(int axis, float angle) {
  return from_axis_angle({axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f}, angle);
}

TEST(Rotation, EulerIsTheProductOfThreeAxisRotations) {
  for (int order = 0; order < 6; ++order) {
    const EulerAngles angles{.first = 0.4f, .second = -0.7f, .third = 1.1f, .order = kOrders[order]};
    const Quat product =
        about(kAxes[order][0], 0.4f) * about(kAxes[order][1], -0.7f) * about(kAxes[order][2], 1.1f);
    EXPECT_LT(apart(from_euler(angles), product), 3.0e-7);
  }
}

TEST(Rotation, EulerRoundTripOfRotations) {
  for (const EulerOrder order : kOrders) {
    for (const Quat q : rotations()) {
      const EulerAngles angles = to_euler(q, order);
      EXPECT_EQ(angles.order, order);
      EXPECT_LE(absolute(angles.second), 0.5f * kPi);
      EXPECT_LE(absolute(angles.first), kPi);
      EXPECT_LE(absolute(angles.third), kPi);
      EXPECT_LT(apart(from_euler(angles), q), 3.0e-6) << q.x << ' ' << q.y << ' ' << q.z << ' ' << q.w;
    }
  }
}

TEST(Rotation, EulerRoundTripOfAngles) {
  Random random;
  for (const EulerOrder order : kOrders) {
    for (int i = 0; i < 500; ++i) {
      const EulerAngles in{.first = random.between(-3.1, 3.1),
                           .second = random.between(-1.5, 1.5),
                           .third = random.between(-3.1, 3.1),
                           .order = order};
      const EulerAngles out = to_euler(from_euler(in), order);
      EXPECT_NEAR(out.first, in.first, 1.0e-5f);
      EXPECT_NEAR(out.second, in.second, 1.0e-6f);
      EXPECT_NEAR(out.third, in.third, 1.0e-5f);
    }
  }
}

TEST(Rotation, GimbalLock) {
  for (const EulerOrder order : kOrders) {
    for (const float second : {0.5f * kPi, -0.5f * kPi}) {
      for (int i = -3; i <= 3; ++i) {
        const Quat q =
            from_euler({.first = 0.9f * float(i), .second = second, .third = 0.5f, .order = order});
        const EulerAngles out = to_euler(q, order);
        EXPECT_NEAR(out.second, second, 1.0e-6f);
        EXPECT_EQ(out.third, 0.0f);
        EXPECT_LT(apart(from_euler(out), q), 3.0e-6);
      }
    }
  }
}

TEST(Rotation, RotatedInertiaIsTheMatrixProduct) {
  Random random;
  const Sym3 inertia{3.0f, 2.0f, 4.0f, 0.3f, -0.2f, 0.5f};
  for (const Quat q : rotations()) {
    const Mat3 r = to_matrix(q);
    const Mat3 expected = r * to_matrix(inertia) * transpose(r);
    EXPECT_LT(distance(to_matrix(rotate_inertia(q, inertia)), expected), 5.0e-6);
    // Rotated back, it is the same tensor again.
    EXPECT_LT(
        distance(to_matrix(rotate_inertia(conjugate(q), rotate_inertia(q, inertia))), to_matrix(inertia)),
        1.0e-5);

    const Vec3 moments{1.0f, 2.0f, 3.0f}, v = random.vector();
    const Sym3 world = rotate_moments(q, moments);
    EXPECT_LT(distance(to_matrix(world), to_matrix(rotate_inertia(q, Sym3{1, 2, 3, 0, 0, 0}))), 2.0e-6);
    EXPECT_LT(gyre::distance(world * v, world_tensor_times(q, moments, v)), 5.0e-6f);
  }
}

TEST(Rotation, PointInertiaIsTheIntegralOfOnePoint) {
  const Vec3 r{1, 2, 3}, spin{0.3f, -0.5f, 0.7f};
  const Vec3 momentum = 2.5f * cross(r, cross(spin, r));
  EXPECT_LT(gyre::distance(point_inertia(2.5f, r) * spin, momentum), 1.0e-5f);
}

TEST(Rotation, IntegrationAddsUpTinyRotations) {
  // A million rotations of 1e-6 rad are one radian, although each is near the resolution of a float quaternion.
  Quat q = from_axis_angle({0, 1, 0}, 0.8f);
  const Quat start = q;
  for (int i = 0; i < 1000000; ++i) q = integrate_rotation(q, {0, 0, 1.0e-6f});
  EXPECT_NEAR(dot(q, q), 1.0f, 3.0e-7f);
  EXPECT_LT(apart(q, from_axis_angle({0, 0, 1}, 1.0f) * start), 0.03);
}

TEST(Rotation, IntegrationRotatesInTheWorldFrame) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Quat q = random.rotation();
    const Vec3 turn = 3.0f * random.vector();
    EXPECT_LT(apart(integrate_rotation(q, turn), from_rotation_vector(turn) * q), 3.0e-7);
    const Quat to = random.rotation();
    EXPECT_LT(apart(integrate_rotation(q, rotation_between(q, to)), to), 5.0e-7);
  }
  EXPECT_EQ(integrate_rotation({0, 0, 0, 1}, {0, 0, 0}), Quat{});
}

TEST(Rotation, DoubleTwinsAgreeWithTheLibrary) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const DVec3 v = 3.0 * DVec3(random.vector());
    const double angle = length(v);
    const DQuat q = exponential_map(v);
    EXPECT_NEAR(q.w, std::cos(0.5 * angle), 1.0e-15);
    EXPECT_NEAR(dot(q, q), 1.0, 1.0e-15);
    if (angle < 3.1) {
      EXPECT_LT(length(logarithm_map(q) - v), 1.0e-14);
    }
    const DVec3 p{DVec3(random.vector())};
    EXPECT_LT(length(rotate_inverse(q, rotate(q, p)) - p), 4.0e-15);
  }
  EXPECT_EQ(normalized(DQuat{0, 0, 0, 0}), DQuat{});
}

TEST(Rotation, ModelMatrixIsThePoseAsSeenFromTheOrigin) {
  const Pose pose{{1.0e9 + 1.0, 2.0, 3.0}, from_axis_angle({1, 2, 3}, 0.7f)};
  const Mat4 m = model_matrix(pose, {1.0e9, 0.0, 0.0}, {1, 2, 3});
  const Vec3 p{0.4f, -0.3f, 0.9f};
  const Vec3 expected = rotate(pose.orientation, Vec3{p.x, 2 * p.y, 3 * p.z}) + Vec3{1, 2, 3};
  const float* e = m.elements;
  EXPECT_NEAR(e[0] * p.x + e[4] * p.y + e[8] * p.z + e[12], expected.x, 1.0e-6f);
  EXPECT_NEAR(e[1] * p.x + e[5] * p.y + e[9] * p.z + e[13], expected.y, 1.0e-6f);
  EXPECT_NEAR(e[2] * p.x + e[6] * p.y + e[10] * p.z + e[14], expected.z, 1.0e-6f);
  EXPECT_EQ(e[3], 0.0f);
  EXPECT_EQ(e[15], 1.0f);
}

}  // namespace
}  // namespace gyre::rotation_test
