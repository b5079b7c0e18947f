// Smoke in pictures: slices fill the box, and smoke shades what lies behind it.
#include "render/smoke.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::smoke_test {
namespace {

float area_of(const std::vector<Vec3>& triangles) {
  float sum = 0;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    sum += 0.5f * length(cross(triangles[i + 1] - triangles[i], triangles[i + 2] - triangles[i]));
  }
  return sum;
}

TEST(Smoke, SlicesFillTheBoxFromFarToNear) {
  const Aabb box{{-1, 0, -0.5f}, {2, 1, 0.5f}};
  const Vec3 eye{3, 4, 5};
  for (const Vec3 forward :
       {Vec3{0, 0, -1}, normalized(Vec3{-0.6f, -0.8f, -1.0f}), normalized(Vec3{-1, 0, 0})}) {
    const SmokeSlices cut = cut_smoke(box, eye, forward, 64, 0.5f);
    EXPECT_NEAR(area_of(cut.triangles) * cut.thickness, 3.0f, 0.01f);
    float before = 1e30f;
    for (const Vec3 place : cut.triangles) {
      const float away = dot(forward, place - eye);
      EXPECT_LT(away, before + 1e-4f);
      before = away;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(place[axis], box.low[axis] - 1e-5f);
        EXPECT_LE(place[axis], box.high[axis] + 1e-5f);
      }
    }
  }
}

TEST(Smoke, NothingIsCutBehindTheEye) {
  EXPECT_TRUE(cut_smoke({{-1, -1, 1}, {1, 1, 2}}, {0, 0, 0}, {0, 0, -1}, 16, 0.5f).triangles.empty());
}

TEST(Smoke, LightFadesAlongItsWayAsBeerAndLambertHaveIt) {
  SmokeVolume volume;
  volume.box = {{0, 0, 0}, {1, 2, 1}};
  volume.cells = {4, 20, 3};
  volume.voxels.resize(4 * 20 * 3);
  volume.extinction = 2.0f;
  for (Voxel& voxel : volume.voxels) voxel.smoke = 128;
  light_smoke(volume, {0, 1, 0});
  for (int y = 0; y < 20; ++y) {
    const float above = float(19 - y) * 0.1f;  // m
    const float expected = 255.0f * std::exp(-2.0f * above * 128.0f / 255.0f);
    EXPECT_NEAR(float(volume.voxels[std::size_t(1 + 4 * (y + 20))].light), expected, 1.0f) << y;
  }
}

TEST(Smoke, ItsShadowLiesAwayFromTheSun) {
  SmokeVolume volume;
  volume.box = {{0, 0, 0}, {1, 1, 1}};
  volume.cells = {11, 11, 11};
  volume.voxels.resize(11 * 11 * 11);
  volume.extinction = 100.0f;
  const auto at = [&](int x, int y, int z) -> Voxel& {
    return volume.voxels[std::size_t(x + 11 * (y + 11 * z))];
  };
  at(5, 5, 5).smoke = 255;
  const Vec3 sun = normalized(Vec3{-1, 1, 0});
  light_smoke(volume, sun);
  EXPECT_LT(at(7, 3, 5).light, 200);
  EXPECT_EQ(at(3, 7, 5).light, 255);
  EXPECT_EQ(at(5, 5, 7).light, 255);
}

}  // namespace
}  // namespace gyre::smoke_test
