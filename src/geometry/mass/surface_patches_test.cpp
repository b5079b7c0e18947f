// Patches against known areas, against the divergence theorem, and against shadows counted point by point.
#include "geometry/mass/surface_patches.h"

#include "geometry/mass/submerged.h"
#include "geometry/shape/support.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::surface_patches_test {
namespace {

struct Known {
  const char* name;
  AnyShape shape;
  double area;
  double slack;  // relative, of sums over patches
};

std::vector<Known> known() {
  const double pi = kPiDouble;
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return {{"sphere", Sphere{0.5f}, pi, 1e-12},
          {"box", Box{{0.5f, 0.25f, 1.0f}}, 2 * (0.5 + 1.0 + 2.0), 1e-12},
          {"capsule", Capsule{0.5f, 0.5f}, 2 * pi * 0.5 * 1 + pi, 1e-12},
          {"cylinder", Cylinder{0.5f, 0.25f}, 2 * pi * 0.5 * 0.5 + 2 * pi * 0.25, 1e-12},
          {"cone", Cone{0.75f, 0.5f}, pi * 0.75 * 1.25 + pi * 0.75 * 0.75, 1e-12},
          {"tetrahedron", *cook_hull(corners), 1.5 + std::sqrt(3.0) / 2, 1e-6}};
}

TEST(SurfacePatches, MakeTheWholeSurface) {
  for (const Known& k : known()) {
    const Shape shape = make_shape(k.shape);
    double area = 0, through = 0;
    DVec3 sum;
    for_each_patch(shape, {0, 1, 0}, double(kUnbounded), [&](const SurfacePatch& p) {
      area += p.area;
      sum += p.area * p.normal;
      through += p.area * dot(p.normal, p.position) / 3;
      EXPECT_NEAR(length(p.normal), 1.0, 1e-6);
    });
    EXPECT_NEAR(area, k.area, k.slack * k.area) << k.name;
    EXPECT_NEAR(length(sum), 0.0, 1e-6 * k.area) << k.name << ": a closed surface has no direction";
    EXPECT_NEAR(through, volume_of(shape), 1e-6 * volume_of(shape)) << k.name << ": Gauss's theorem";
  }
}

// A direction's shadow, by rays through a grid across it: 400 x 400 points, so within a percent of the rim's share.
TEST(SurfacePatches, ShadowsAreWhatRaysCount) {
  const DVec3 directions[] = {
      {0, 1, 0}, {1, 0, 0}, {0.6, 0.8, 0}, {0.48, -0.6, 0.64}, {0.8, 0.2, 0.5656854249}};
  for (const Known& k : known()) {
    const Shape shape = make_shape(k.shape);
    for (const DVec3& raw : directions) {
      const DVec3 d = raw / length(raw);
      const Vec3 u = any_perpendicular(to_float(d)), v = cross(to_float(d), u);
      // The shadow is convex: its area by its support function, 1/2 the integral of p (p + p'') over the directions, is
      // the polygon of support points.
      constexpr int kSides = 2000;
      double twice = 0;
      double x0 = 0, y0 = 0;
      for (int i = 0; i <= kSides; ++i) {
        const double angle = 2 * kPiDouble * i / kSides;
        const Vec3 w = float(std::cos(angle)) * u + float(std::sin(angle)) * v;
        Vec3 p = support(shape, w);
        if (shape.kind != ShapeKind::box) p += core_radius(shape) * w;
        const double x = double(dot(p, u)), y = double(dot(p, v));
        if (i > 0) twice += x0 * y - x * y0;
        x0 = x, y0 = y;
      }
      EXPECT_NEAR(projected_area(shape, d), 0.5 * twice, 2e-4 * k.area) << k.name;
      double windward = 0;
      for_each_patch(shape, d, double(kUnbounded),
                     [&](const SurfacePatch& p) { windward += std::fmax(-dot(p.normal, d), 0.0) * p.area; });
      EXPECT_NEAR(windward, projected_area(shape, d), 0.05 * projected_area(shape, d)) << k.name;
    }
  }
}

// Under half a plane: the wetted area of a box and of a cylinder that stand in it, exactly or within a ring's height.
TEST(SurfacePatches, OnlyWhatIsBelow) {
  const auto below = [](const AnyShape& any, DVec3 n, double level) {
    double area = 0;
    for_each_patch(make_shape(any), n, level, [&](const SurfacePatch& p) { area += p.area; });
    return area;
  };
  EXPECT_NEAR(below(Box{{1, 1, 1}}, {0, 1, 0}, -0.25), 4 + 8 * 0.75, 1e-12);
  EXPECT_NEAR(below(Box{{1, 1, 1}}, {0, 1, 0}, -1.5), 0.0, 1e-12);
  const double sqrt_half = std::sqrt(0.5);
  EXPECT_NEAR(below(Box{{1, 1, 1}}, {sqrt_half, sqrt_half, 0}, 0.0), 12.0, 1e-12);
  const double cylinder =
      2 * kPiDouble * 1 * 1 + kPiDouble;  // lid and half the side of one of radius 1, height 2
  EXPECT_NEAR(below(Cylinder{1, 1}, {0, 1, 0}, 0.0), cylinder, 0.05 * cylinder);
  EXPECT_NEAR(below(Sphere{1}, {0, 1, 0}, 0.0), 2 * kPiDouble, 0.02 * kPiDouble);
}

}  // namespace
}  // namespace gyre::surface_patches_test
