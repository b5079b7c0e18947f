// The camera against a pinhole worked out by hand, and its matrix against its own projection.
#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::camera_test {
namespace {

struct Clip {
  float x, y, z, w;
};
Clip times(const Mat4& m, Vec3 p) {
  const auto row = [&](int i) {
    return m.elements[i] * p.x + m.elements[4 + i] * p.y + m.elements[8 + i] * p.z + m.elements[12 + i];
  };
  return {row(0), row(1), row(2), row(3)};
}

TEST(Camera, APinholeAsWorkedOutByHand) {
  // From (0, 0, 10) along -z with a quarter turn from bottom to top: at 10 m the picture is 20 m high, 20 pixels a metre.
  Camera camera{{0, 0, 10}, {0, 0, 0}, 1.5707964f, 600, 400};
  const PicturePoint corner = project(camera, {1, 2, 0});
  EXPECT_NEAR(corner.x, 300 + 20, 1e-3f);
  EXPECT_NEAR(corner.y, 200 - 40, 1e-3f);
  EXPECT_NEAR(corner.depth, 10, 1e-5f);
  EXPECT_LT(project(camera, {0, 0, 11}).depth, 0);
  // From above, north (-z) is up and east (x) is right.
  camera.eye = {0, 10, 0};
  EXPECT_NEAR(project(camera, {1, 0, -2}).x, 320, 1e-3f);
  EXPECT_NEAR(project(camera, {1, 0, -2}).y, 160, 1e-3f);
}

TEST(Camera, TheMatrixGoesWhereTheProjectionSays) {
  const Camera camera{{1e7 + 3, 2, 5}, {1e7, 0.5, -1}, 0.7f, 320, 200};
  const DVec3 origin{1e7, 0, 0};
  const ClipRange range{0.1f, 100};
  for (const Vec3 place : {Vec3{0, 0, 0}, Vec3{1, 1, -3}, Vec3{-2, 0.5f, 1}}) {
    const PicturePoint seen = project(camera, origin + place);
    const Clip clip = times(clip_matrix(camera, origin, range, 0, 0), place);
    EXPECT_NEAR((clip.x / clip.w + 1) * 160, seen.x, 1e-3f);
    EXPECT_NEAR((1 - clip.y / clip.w) * 100, seen.y, 1e-3f);
    EXPECT_NEAR(clip.w, seen.depth, 1e-4f);
    // Moved by part of a pixel, right and up.
    const Clip moved = times(clip_matrix(camera, origin, range, 0.25f, 0.5f), place);
    EXPECT_NEAR((moved.x / moved.w + 1) * 160, seen.x + 0.25f, 1e-3f);
    EXPECT_NEAR((1 - moved.y / moved.w) * 100, seen.y - 0.5f, 1e-3f);
  }
  const Vec3 back = axes_of(camera).back;
  const Vec3 eye = difference(camera.eye, origin);
  const Clip near = times(clip_matrix(camera, origin, range, 0, 0), eye - range.near * back);
  const Clip far = times(clip_matrix(camera, origin, range, 0, 0), eye - range.far * back);
  EXPECT_NEAR(near.z / near.w, -1, 1e-4f);
  EXPECT_NEAR(far.z / far.w, 1, 1e-4f);
}

TEST(Camera, AShadowMapHoldsItsBox) {
  const Aabb box{{-1, 0, -2}, {3, 1, 0.5f}};
  const CameraAxes axes = axes_towards({0.3f, 0.8f, -0.4f});
  const Mat4 matrix = shadow_matrix(axes, box_along(axes, box));
  float reach = 0, nearest = 1, farthest = -1;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 place{corner & 1 ? 3.0f : -1.0f, corner & 2 ? 1.0f : 0.0f, corner & 4 ? 0.5f : -2.0f};
    const Clip clip = times(matrix, place);
    EXPECT_EQ(clip.w, 1.0f);
    reach = std::fmax(reach, std::fmax(std::fabs(clip.x), std::fabs(clip.y)));
    nearest = std::fmin(nearest, clip.z);
    farthest = std::fmax(farthest, clip.z);
  }
  EXPECT_NEAR(reach, 1, 1e-5f);
  EXPECT_NEAR(nearest, -1, 1e-5f);
  EXPECT_NEAR(farthest, 1, 1e-5f);
}

}  // namespace
}  // namespace gyre::camera_test
