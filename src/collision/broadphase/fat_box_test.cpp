// Fat boxes contain their shape at any distance from the origin, change rarely, and do not stay too large.
#include "collision/broadphase/fat_box.h"

#include "geometry/shape/support.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

#include <limits>

namespace gyre::fat_box_test {
namespace {

bool is_inside(const WorldBox& inner, const Aabb& box) {
  const DVec3 low(box.low), high(box.high);
  return low.x <= inner.low.x && low.y <= inner.low.y && low.z <= inner.low.z && high.x >= inner.high.x &&
         high.y >= inner.high.y && high.z >= inner.high.z;
}

TEST(FatBox, WorldBoxContainsEveryPoint) {
  test::Random random{5};
  const AnyShape kinds[] = {Sphere{0.7f},        Box{{0.2f, 1.5f, 0.01f}}, Box{{0.5f, 0.5f, 0.5f}, 0.2f},
                            Capsule{0.1f, 2.0f}, Cylinder{1.0f, 0.1f},     Cone{0.5f, 1.0f}};
  for (const AnyShape& kind : kinds) {
    const Shape shape = make_shape(kind);
    for (int round = 0; round < 300; ++round) {
      const double far = round % 3 == 0 ? 0.0 : round % 3 == 1 ? 1.0e3 : 1.0e7;
      // Some nearly along the axes, so that discs are seen from the side.
      const Quat orientation =
          round % 5 == 0 ? from_rotation_vector(random.in_box(1.0e-3f)) : random.rotation();
      const Pose pose{DVec3{far, -far, 0.3 * far} + DVec3(random.in_box(10.0f)), orientation};
      const WorldBox box = world_box(shape, pose);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 direction{axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f};
        for (const float sign : {-1.0f, 1.0f}) {
          const Vec3 local = support(shape, rotate_inverse(pose.orientation, sign * direction));
          const double extent = double(sign) * (pose * local)[axis] + double(core_radius(shape));
          EXPECT_LE(extent, double(sign) * (sign > 0 ? box.high[axis] : box.low[axis]));
          EXPECT_GE(extent + 1.3e-3, double(sign) * (sign > 0 ? box.high[axis] : box.low[axis]));
        }
      }
      EXPECT_TRUE(is_inside(box, round_outward(box)));
    }
  }
}

TEST(FatBox, RoundsOutwardByTheLeastStep) {
  const double values[] = {0.0,      1.0,        1.0 + 1.0e-9, -1.0 - 1.0e-9, 1.0e-40,
                           -1.0e-40, 16777217.0, -16777217.0,  3.0e30};
  for (const double value : values) {
    const Aabb box = round_outward({{value, value, value}, {value, value, value}});
    EXPECT_LE(double(box.low.x), value);
    EXPECT_GE(double(box.high.x), value);
    EXPECT_LE(double(box.high.x) - double(box.low.x), 1.2e-7 * std::abs(value) + 3.0e-38);
  }
}

TEST(FatBox, ChangesRarelyAndShrinksAgain) {
  const BoxMotion slow{0.5f, {0.001f, 0, 0}, 0.0f};
  WorldBox tight{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
  Aabb fat = fat_box(needed_box(tight, slow), slow);
  int changes = 0;
  for (int step = 0; step < 1000; ++step) {
    tight.low.x += 0.001, tight.high.x += 0.001;
    const WorldBox needed = needed_box(tight, slow);
    if (!needs_refit(fat, needed, slow)) {
      ASSERT_TRUE(is_inside(needed, fat));
      continue;
    }
    fat = fat_box(needed, slow);
    ++changes;
  }
  EXPECT_LT(changes, 45);
  // After fast motion the box is long; at rest it must become smaller.
  const BoxMotion fast{0.5f, {30, 0, 0}, 0.0f};
  const Aabb longest = fat_box(needed_box(tight, fast), fast);
  EXPECT_FALSE(needs_refit(longest, needed_box(tight, fast), fast));
  EXPECT_TRUE(needs_refit(longest, needed_box(tight, slow), slow));
}

TEST(FatBox, FarFromTheOriginItIsNotMadeAnewForever) {
  const BoxMotion motion{0.001f, {}, 0.0f};
  for (const double far : {1.0e4, 1.0e6, 1.0e8}) {
    const WorldBox needed = needed_box({{far, far, far}, {far + 0.002, far + 0.002, far + 0.002}}, motion);
    EXPECT_FALSE(needs_refit(fat_box(needed, motion), needed, motion)) << far;
  }
}

TEST(FatBox, PlanesAreUnbounded) {
  const Shape plane = make_shape(Plane{{0, 1, 0}, 2.0f});
  const BoxMotion motion{inner_radius(plane), {}, 0.0f};
  const WorldBox needed = needed_box(world_box(plane, {{1, 3, 5}, {}}), motion);
  const Aabb box = fat_box(needed, motion);
  EXPECT_TRUE(is_unbounded(box));
  EXPECT_NEAR(box.high.y, 5.0f, 1.0e-4f) << "an axis-aligned plane keeps its height";
  EXPECT_FALSE(needs_refit(box, needed, motion));
  EXPECT_FALSE(is_unbounded({{-1.0e9f, -1, -1}, {1.0e9f, 1, 1}}));
}

// A shape beyond the range of floats, or with NaN, has a finite box that contains whatever is finite.
TEST(FatBox, EndsWhereFloatsEnd) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  constexpr float kMost = std::numeric_limits<float>::max();
  const Aabb box = round_outward({{-1.0e39, -kInfinity, kNoNumber}, {1.0e300, -1.0e300, kNoNumber}});
  EXPECT_EQ(box.low, (Vec3{-kMost, -kMost, -kMost}));
  EXPECT_EQ(box.high, (Vec3{kMost, -kMost, kMost}));
}

}  // namespace
}  // namespace gyre::fat_box_test
