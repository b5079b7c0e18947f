// Wide vectors have the bits of the scalar ones; gather and scatter move exactly the given records.
#include "math/wide_vec.h"

#include "random.h"

#include <gtest/gtest.h>
#include <gyre/math.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "math/rotation.h"
#include "math/wide_angle.h"

namespace gyre::wide_vec_test {
namespace {

struct Random : testing_random::Mixed {
  Random() : Mixed{0xbf58476d1ce4e5b9u} {}
  float between(float low, float high) { return single(low, high); }
  Vec3 vector() { return {between(-2, 2), between(-2, 2), between(-2, 2)}; }
};

Vec3 lane(const Vec3W<4>& v, int i) { return {v.x[i], v.y[i], v.z[i]}; }
Quat lane(const QuatW<4>& q, int i) { return {q.x[i], q.y[i], q.z[i], q.w[i]}; }
Sym3 lane(const Sym3W<4>& m, int i) { return {m.xx[i], m.yy[i], m.zz[i], m.xy[i], m.xz[i], m.yz[i]}; }
Mat3 lane(const Mat3W<4>& m, int i) { return {lane(m.x, i), lane(m.y, i), lane(m.z, i)}; }

// Within the error of the wide atan2, 3e-7 of at most pi, and rounding.
TEST(WideVec, RotationVectorsAreThoseOfTheQuaternions) {
  Random random;
  const auto expect_same = [](Quat q) {
    const Vec3 wide = lane(to_rotation_vector(QuatW<4>{q.x, q.y, q.z, q.w}), 3), one = to_rotation_vector(q);
    // A rotation by pi about an axis equals that about the opposite axis.
    const bool is_half = std::abs(q.w) < 1.0e-6f;
    const float apart = is_half ? std::min(length(wide - one), length(wide + one)) : length(wide - one);
    EXPECT_LT(apart, 2.0e-6f + 1.0e-6f * length(one)) << q.x << " " << q.y << " " << q.z << " " << q.w;
  };
  for (int round = 0; round < 2000; ++round) {
    const Vec3 axis = normalized(random.vector());
    for (const float angle : {random.between(-kPi, kPi), 1.0e-4f, 1.0e-20f, 0.0f, kPi, 3.1415f})
      for (const float sign : {1.0f, -1.0f}) {
        const Quat q = from_axis_angle(axis, angle);
        expect_same({sign * q.x, sign * q.y, sign * q.z, sign * q.w});
      }
  }
  EXPECT_EQ(lane(to_rotation_vector(QuatW<4>{1.0e-9f, 0.0f, 0.0f, 1.0f}), 0), (Vec3{2.0e-9f, 0, 0}))
      << "small turns are told to their last bits";
}

TEST(WideVec, LanesHaveTheBitsOfTheScalarOperations) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    Vec3 u[4], v[4];
    Sym3 t[4];
    Quat q[4];
    float s[4];
    Vec3W<4> uw{}, vw{};
    QuatW<4> qw{};
    Sym3W<4> tw{};
    Wide<4> sw{};
    for (int i = 0; i < 4; ++i) {
      u[i] = random.vector();
      v[i] = random.vector();
      if (round % 10 == 0 && i % 3 == 0) u[i] = {};
      t[i] = {3 + u[i].x, 4 + u[i].y, 5 + u[i].z, v[i].x, v[i].y, v[i].z};
      if (round % 10 == 1 && i % 2 == 0) t[i] = {1, 1, 1, 1, 1, 1};
      q[i] = normalized(
          Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
      s[i] = random.between(-3, 3);
      uw.x.set(i, u[i].x), uw.y.set(i, u[i].y), uw.z.set(i, u[i].z);
      vw.x.set(i, v[i].x), vw.y.set(i, v[i].y), vw.z.set(i, v[i].z);
      qw.x.set(i, q[i].x), qw.y.set(i, q[i].y), qw.z.set(i, q[i].z), qw.w.set(i, q[i].w);
      tw.xx.set(i, t[i].xx), tw.yy.set(i, t[i].yy), tw.zz.set(i, t[i].zz);
      tw.xy.set(i, t[i].xy), tw.xz.set(i, t[i].xz), tw.yz.set(i, t[i].yz);
      sw.set(i, s[i]);
    }
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(lane(uw + vw, i), u[i] + v[i]);
      EXPECT_EQ(lane(uw - vw, i), u[i] - v[i]);
      EXPECT_EQ(lane(-uw, i), -u[i]);
      EXPECT_EQ(lane(sw * uw, i), s[i] * u[i]);
      EXPECT_EQ(lane(uw * sw, i), u[i] * s[i]);
      EXPECT_EQ(lane(uw / sw, i), u[i] / s[i]);
      EXPECT_EQ(dot(uw, vw)[i], dot(u[i], v[i]));
      EXPECT_EQ(lane(cross(uw, vw), i), cross(u[i], v[i]));
      EXPECT_EQ(lane(multiply_each(uw, vw), i), multiply_each(u[i], v[i]));
      EXPECT_EQ(lane(min(uw, vw), i), min(u[i], v[i]));
      EXPECT_EQ(lane(max(uw, vw), i), max(u[i], v[i]));
      EXPECT_EQ(lane(absolute(uw), i), absolute(u[i]));
      EXPECT_EQ(largest(uw)[i], largest(u[i]));
      EXPECT_EQ(smallest(uw)[i], smallest(u[i]));
      EXPECT_EQ(length(uw)[i], length(u[i]));
      EXPECT_EQ(lane(lerp(uw, vw, sw), i), lerp(u[i], v[i], s[i]));
      EXPECT_EQ(lane(normalized(uw, vw), i), normalized(u[i], v[i]));
      EXPECT_EQ(lane(tw * vw, i), t[i] * v[i]);
      EXPECT_EQ(lane(inverse(tw), i), inverse(t[i]));
      EXPECT_EQ(lane(tw + tw, i), t[i] + t[i]);
      EXPECT_EQ(lane(sw * tw, i), s[i] * t[i]);
      EXPECT_EQ(lane(qw * conjugate(qw), i), q[i] * conjugate(q[i]));
      EXPECT_EQ(lane(normalized(qw), i), normalized(q[i]));
      EXPECT_EQ(lane(rotate(qw, vw), i), rotate(q[i], v[i]));
      EXPECT_EQ(lane(rotate_inverse(qw, vw), i), rotate_inverse(q[i], v[i]));
      EXPECT_EQ(lane(to_matrix(qw), i), to_matrix(q[i]));
      EXPECT_EQ(lane(to_matrix(qw) * vw, i), to_matrix(q[i]) * v[i]);
      EXPECT_EQ(lane(to_matrix(qw) * to_matrix(qw), i), to_matrix(q[i]) * to_matrix(q[i]));
      EXPECT_EQ(lane(transpose_times(to_matrix(qw), vw), i), transpose_times(to_matrix(q[i]), v[i]));
      EXPECT_EQ(lane(rotate_inertia(to_matrix(qw), tw), i), rotate_inertia(to_matrix(q[i]), t[i]));
      EXPECT_EQ(lane(rotate_moments(to_matrix(qw), uw), i), rotate_moments(to_matrix(q[i]), u[i]));
    }
  }
}

TEST(WideVec, SinCosWithinItsError) {
  double worst = 0.0, worst_far = 0.0;
  for (int i = -400000; i <= 400000; i += 4) {
    Wide<4> x{};
    for (int k = 0; k < 4; ++k) x.set(k, float(i + k) * 0.0200017f);
    const SinCosW<4> found = sin_cos(x);
    for (int k = 0; k < 4; ++k) {
      worst = std::fmax(worst, std::fabs(double(found.sin[k]) - std::sin(double(x[k]))));
      worst = std::fmax(worst, std::fabs(double(found.cos[k]) - std::cos(double(x[k]))));
      const SinCosW<1> far = sin_cos(Wide<1>(100.0f * x[k]));
      worst_far = std::fmax(worst_far, std::fabs(double(far.sin.v) * double(far.sin.v) +
                                                 double(far.cos.v) * double(far.cos.v) - 1.0));
    }
  }
  EXPECT_LT(worst, 2.0 * 0x1p-24);
  EXPECT_LT(worst_far, 1.0e-3);
  const SinCosW<1> zero = sin_cos(Wide<1>(0.0f));
  EXPECT_EQ(zero.sin.v, 0.0f);
  EXPECT_EQ(zero.cos.v, 1.0f);
}

TEST(WideVec, IntegrationFollowsTheDoubleOne) {
  Random random;
  for (int round = 0; round < 4000; ++round) {
    const Quat q = normalized(
        Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
    // Tiny, ordinary and full rotations.
    const float size = std::pow(10.0f, random.between(-12, 1.5f));
    const Vec3 turn = size * random.vector();
    const QuatW<1> found = integrate_rotation(QuatW<1>{q.x, q.y, q.z, q.w}, Vec3W<1>{turn.x, turn.y, turn.z});
    const Quat exact = integrate_rotation(q, turn);
    const float tolerance = 4.0e-7f + 1.0e-7f * length(turn);  // the angle itself is rounded
    EXPECT_NEAR(found.x.v, exact.x, tolerance);
    EXPECT_NEAR(found.y.v, exact.y, tolerance);
    EXPECT_NEAR(found.z.v, exact.z, tolerance);
    EXPECT_NEAR(found.w.v, exact.w, tolerance);
  }
}

TEST(WideVec, IntegrationOfALaneIgnoresItsNeighbours) {
  const QuatW<4> still{0.0f, 0.0f, 0.0f, 1.0f};
  Vec3W<4> slow = splat<4>(Vec3{0.1f, 0.2f, 0.3f});
  Vec3W<4> mixed = slow;
  mixed.x.set(2, 50.0f);
  const QuatW<4> a = integrate_rotation(still, slow), b = integrate_rotation(still, mixed);
  for (const int i : {0, 1, 3}) {
    EXPECT_EQ(a.x[i], b.x[i]);
    EXPECT_EQ(a.w[i], b.w[i]);
  }
  EXPECT_NE(a.x[2], b.x[2]);
}

constexpr int kRecords = 40;

std::vector<float> records() {
  std::vector<float> list;
  for (int i = 0; i < kRecords * kRecordFloats; ++i) list.push_back(float(i) + 0.25f);
  return list;
}

// Some lanes without a record; the others all different.
template <int W>
void fill_indices(int round, std::int32_t (&indices)[W]) {
  for (int i = 0; i < W; ++i) {
    indices[i] = (round >> (i % 5)) & 1 ? -1 - i : (7 * i + round) % kRecords;
  }
}

template <int Columns, int W>
void expect_gather() {
  const std::vector<float> memory = records();
  for (int round = 0; round < 40; ++round) {
    std::int32_t indices[W];
    fill_indices(round, indices);
    Wide<W> out[Columns];
    gather<Columns, W>(memory.data(), indices, out);
    for (int c = 0; c < Columns; ++c) {
      for (int i = 0; i < W; ++i) {
        EXPECT_EQ(out[c][i], indices[i] < 0 ? 0.0f : memory[std::size_t(indices[i] * kRecordFloats + c)]);
      }
    }
  }
}

template <int Columns, int W>
void expect_scatter() {
  for (int round = 0; round < 40; ++round) {
    std::vector<float> memory = records(), expected = memory;
    std::int32_t indices[W];
    fill_indices(round, indices);
    Wide<W> in[Columns]{};
    for (int c = 0; c < Columns; ++c) {
      for (int i = 0; i < W; ++i) {
        in[c].set(i, float(-1000 * c - i));
        if (indices[i] >= 0) expected[std::size_t(indices[i] * kRecordFloats + c)] = in[c][i];
      }
    }
    scatter<Columns, W>(memory.data(), indices, in);
    EXPECT_EQ(memory, expected);
  }
}

template <int W>
void expect_moves() {
  expect_gather<4, W>();
  expect_gather<8, W>();
  expect_gather<12, W>();
  expect_gather<16, W>();
  expect_scatter<1, W>();
  expect_scatter<3, W>();
  expect_scatter<4, W>();
  expect_scatter<6, W>();
  expect_scatter<8, W>();
  expect_scatter<13, W>();
  expect_scatter<16, W>();
}

// The other widths are compared with these in wide_test.cpp.
TEST(WideVec, GatherAndScatterMoveTheirRecordsOnly) {
  expect_moves<1>();
  expect_moves<4>();
}

TEST(WideVec, AllBitsSurviveTheRoundTrip) {
  // NaN payloads, denormals and negative zeros are data here, not numbers.
  std::vector<float> memory(std::size_t(4) * kRecordFloats);
  for (std::size_t i = 0; i < memory.size(); ++i)
    memory[i] = __builtin_bit_cast(float, std::uint32_t(0x7f80abcdu + 77u * i));
  std::vector<float> copy(memory.size(), 0.0f);
  const std::int32_t indices[4] = {3, 1, 0, 2};
  Wide<4> columns[16];
  gather16<4>(memory.data(), indices, columns);
  scatter<16, 4>(copy.data(), indices, columns);
  EXPECT_EQ(std::memcmp(memory.data(), copy.data(), memory.size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace gyre::wide_vec_test
