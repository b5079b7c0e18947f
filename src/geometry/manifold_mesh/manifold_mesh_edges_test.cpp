// Surfaces with real edges: ridges, valleys, walls, steps, borders, and adjacent pieces.
#include "geometry/distance/closest.h"
#include "geometry/manifold_mesh/manifold_mesh.h"
#include "geometry/query/closest_points.h"
#include "geometry/shape/cooked.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::manifold_mesh_edges_test {
namespace {

using namespace test;

struct Nearest {
  double distance = 1.0e9;
  DVec3 point;
  std::uint32_t triangle = 0;
};

Nearest nearest_by_brute_force(const Mesh& mesh, Vec3 center) {
  Nearest best;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleView view = view_triangle(mesh, t);
    const DVec3 p =
        closest_on_triangle(DVec3(center), DVec3(view.v[0]), DVec3(view.v[1]), DVec3(view.v[2])).point;
    const double d = length(DVec3(center) - p);
    if (d < best.distance) best = {d, p, t};
  }
  return best;
}

// True if some triangle with this normal has the point in its plane within `reach`, and the closest feature is a
// valley: an edge shared with a triangle that rises before its plane. A ball may come over such a triangle.
bool lies_beyond_a_valley(const Mesh& mesh, Vec3 point, Vec3 normal, float reach) {
  const DVec3 p(point);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleView view = view_triangle(mesh, t);
    const DVec3 n(view.normal),
        foot = closest_on_triangle(p, DVec3(view.v[0]), DVec3(view.v[1]), DVec3(view.v[2])).point;
    if (length(view.normal - normal) > 0.04f || absolute(dot(n, p - DVec3(view.v[0]))) > 1.0e-3 ||
        length(p - foot) > double(reach))
      continue;
    for (std::uint32_t k = 0; k < mesh.triangle_count(); ++k) {
      const TriangleView other = view_triangle(mesh, k);
      int shared = 0;
      double before = 0.0;
      for (const Vec3 v : other.v) {
        const bool is_shared = v == view.v[0] || v == view.v[1] || v == view.v[2];
        shared += is_shared;
        if (!is_shared) before = dot(n, DVec3(v) - DVec3(view.v[0]));
      }
      const DVec3 on_other =
          closest_on_triangle(foot, DVec3(other.v[0]), DVec3(other.v[1]), DVec3(other.v[2])).point;
      if (shared == 2 && before > 0.0 && length(on_other - foot) < 1.0e-5) return true;
    }
  }
  return false;
}

TEST(CollideMeshEdges, SphereEqualsBruteForceOnRoughGround) {
  Random random{71};
  int touching = 0, beyond_valleys = 0;
  for (int round = 0; round < 6; ++round) {
    const Geometry ground =
        grid(3.0f, 0.4f, [&](float, float) { return random.between(0.0f, round < 3 ? 0.1f : 0.5f); }).cook();
    const Mesh& mesh = *ground.data()->mesh;
    for (int i = 0; i < 500; ++i) {
      SCOPED_TRACE(testing::Message() << "round " << round << ", sphere " << i);
      const float radius = i % 2 == 0 ? 0.5f : 0.1f;
      const Vec3 center{random.between(-2, 2), 0.0f, random.between(-2, 2)};
      // Down until the sphere just touches, a little more or less.
      float y = 2.0f;
      for (int k = 0; k < 40; ++k) {
        const float d = float(nearest_by_brute_force(mesh, {center.x, y, center.z}).distance) - radius;
        y -= d;
        if (d < 1.0e-6f) break;
      }
      y += random.between(-0.02f, 0.015f);
      const Vec3 place{center.x, y, center.z};
      const Nearest want = nearest_by_brute_force(mesh, place);
      const float separation = float(want.distance) - radius;
      const Manifolds found = collide(ground, Sphere{radius}, {place, random.rotation()});
      if (separation > kMargin) {
        EXPECT_EQ(found.count, 0);
        continue;
      }
      ++touching;
      ASSERT_GE(found.count, 1);
      EXPECT_NEAR(found.deepest(), separation, 2.0e-5f);
      const Vec3 normal = to_float((DVec3(place) - want.point) / want.distance);
      EXPECT_NE(found.along(normal, 0.03f), nullptr);
      // Every contact touches the sphere along its normal, so none pushes from a place without surface. Only contacts
      // beyond valleys do not touch yet.
      for (int m = 0; m < found.count; ++m) {
        const LocalManifold& manifold = found.all[m];
        const ManifoldPoint& p = manifold.points[0];
        const Vec3 on_surface = p.position - 0.5f * p.separation * manifold.normal;
        if (nearest_by_brute_force(mesh, on_surface).distance < 2.0e-3) continue;
        ++beyond_valleys;
        EXPECT_GE(p.separation, 0.0f);
        EXPECT_TRUE(lies_beyond_a_valley(mesh, on_surface, manifold.normal, kMargin));
      }
    }
  }
  EXPECT_GT(beyond_valleys, 20);
  EXPECT_GT(touching, 2500);
}

TEST(CollideMeshEdges, ARollingSphereTurnsOverARidge) {
  for (const float slope : {0.05f, 0.5f, 2.0f}) {
    const Geometry roof = grid(4.0f, 0.5f, [&](float x, float) { return -slope * std::fabs(x); }).cook();
    const float radius = 0.5f;
    const Vec3 left = normalized(Vec3{-slope, 1, 0}), right = normalized(Vec3{slope, 1, 0});
    for (int i = -50; i <= 50; ++i) {
      // Over the ridge in an arc, at a height where it just touches.
      const float angle = 0.03f * float(i);
      Vec3 normal{sin_cos(angle).sin, sin_cos(angle).cos, 0.0f};
      Vec3 touch{0, 0, 0.13f};
      if (normal.x > right.x) normal = right, touch = {0.1f, -0.1f * slope, 0.13f};
      if (normal.x < left.x) normal = left, touch = {-0.1f, -0.1f * slope, 0.13f};
      const Manifolds found = collide(roof, Sphere{radius}, {touch + (radius - 1.0e-4f) * normal, {}});
      ASSERT_EQ(found.count, 1) << "slope " << slope << ", angle " << angle;
      EXPECT_LT(length(found.all[0].normal - normal), 2.0e-3f) << "slope " << slope << ", angle " << angle;
      EXPECT_NEAR(found.deepest(), -1.0e-4f, 1.0e-5f);
    }
  }
}

TEST(CollideMeshEdges, ABoxInAValleyTouchesBothSides) {
  const Geometry valley = grid(4.0f, 0.5f, [](float x, float) { return std::fabs(x); }).cook();
  const Vec3 left = normalized(Vec3{1, 1, 0}), right = normalized(Vec3{-1, 1, 0});
  const Quat turned = from_axis_angle({0, 0, 1}, 0.25f * kPi);
  for (const AnyShape& shape :
       {AnyShape(Box{{0.5f, 0.5f, 0.5f}}), AnyShape(Box{{0.5f, 0.5f, 0.5f}, 0.05f})}) {
    const float lift = std::sqrt(0.5f) - 1.0e-3f;
    const Manifolds found = collide(valley, shape, {{0, lift, 0.2f}, turned});
    ASSERT_EQ(found.count, 2);
    for (const Vec3 side : {left, right}) {
      const LocalManifold* manifold = found.along(side, 1.0e-4f);
      ASSERT_NE(manifold, nullptr);
      EXPECT_EQ(manifold->count, 4);
      for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(manifold->points[k].separation, -1.0e-3f * std::sqrt(0.5f), 1.0e-5f);
    }
  }
  const Manifolds ball = collide(valley, Sphere{0.5f}, {{0, 0.5f * std::sqrt(2.0f) - 1.0e-3f, 0.2f}, {}});
  ASSERT_EQ(ball.count, 2);
  EXPECT_NE(ball.along(left, 1.0e-4f), nullptr);
  EXPECT_NE(ball.along(right, 1.0e-4f), nullptr);
}

TEST(CollideMeshEdges, ABoxInACornerTouchesFloorAndWall) {
  // A floor, and a wall at x = 2 that faces -x, both in cells of 0.25 m.
  Triangles room = flat_grid(2.0f, 0.25f);
  Triangles wall = flat_grid(2.0f, 0.25f);
  const std::uint32_t base = std::uint32_t(room.vertices.size());
  for (const Vec3 v : wall.vertices) room.vertex({2.0f, v.x + 2.0f, v.z});
  for (std::size_t i = 0; i < wall.indices.size(); i += 3) {
    room.triangle(base + wall.indices[i], base + wall.indices[i + 1], base + wall.indices[i + 2]);
  }
  const Geometry ground = room.cook();
  for (const float depth : {1.0e-4f, 1.0e-3f, 5.0e-3f, -5.0e-3f}) {
    SCOPED_TRACE(depth);
    for (float z = -1.0f; z < 1.0f; z += 0.11f) {
      const Manifolds found = collide(ground, Box{{0.3f, 0.3f, 0.3f}}, {{1.7f + depth, 0.3f - depth, z}, {}});
      ASSERT_EQ(found.count, 2);
      const LocalManifold *up = found.along(kUp, 1.0e-6f), *side = found.along({-1, 0, 0}, 1.0e-6f);
      ASSERT_NE(up, nullptr);
      ASSERT_NE(side, nullptr);
      EXPECT_EQ(up->count, 4);
      EXPECT_EQ(side->count, 4);
      EXPECT_NEAR(up->points[0].separation, -depth, 1.0e-6f);
      EXPECT_NEAR(side->points[0].separation, -depth, 1.0e-6f);
    }
  }
}

// A wall 0.2 m thick and 2 m high, its top along z, in cells of `cell`.
Triangles thin_wall(float cell) {
  Triangles out;
  const auto sheet = [&](Vec3 origin, Vec3 u, Vec3 v) {
    const int nu = max(1, int(length(u) / cell + 0.5f)), nv = max(1, int(length(v) / cell + 0.5f));
    for (int i = 0; i < nu; ++i) {
      for (int k = 0; k < nv; ++k) {
        const auto at = [&](int a, int b) {
          return origin + (float(a) / float(nu)) * u + (float(b) / float(nv)) * v;
        };
        out.quad(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
      }
    }
  };
  sheet({0.1f, -2, 2}, {0, 0, -4}, {0, 2, 0});
  sheet({-0.1f, -2, -2}, {0, 0, 4}, {0, 2, 0});
  sheet({-0.1f, 0, 2}, {0.2f, 0, 0}, {0, 0, -4});
  return out;
}

TEST(CollideMeshEdges, ABodySunkIntoTheTopOfAWallIsNotPushedSideways) {
  Random random{73};
  for (const float cell : {4.0f, 0.5f, 0.05f}) {
    const Geometry wall = thin_wall(cell).cook();
    for (const AnyShape& shape : {AnyShape(Box{{0.5f, 0.5f, 0.5f}}), AnyShape(Cylinder{0.5f, 0.5f}),
                                  AnyShape(Box{{0.5f, 0.5f, 0.5f}, 0.1f})}) {
      for (int i = 0; i < 40; ++i) {
        const float depth = random.between(-0.01f, 0.06f);
        SCOPED_TRACE(testing::Message() << "cell " << cell << ", depth " << depth);
        const Transform pose{{random.between(-0.1f, 0.1f), 0.5f - depth, random.between(-1, 1)},
                             from_axis_angle(kUp, random.between(-3, 3))};
        const Manifolds found = collide(wall, shape, pose);
        ASSERT_EQ(found.count, 1);
        EXPECT_LT(length(found.all[0].normal - kUp), 1.0e-6f);
        EXPECT_NEAR(found.deepest(), -depth, 1.0e-5f);
        EXPECT_GE(found.points(), 3);
      }
    }
  }
}

TEST(CollideMeshEdges, ABoxBeforeAStepIsStopped) {
  // Steps of 0.2 m.
  Triangles stairs;
  for (int i = 0; i < 5; ++i) {
    const float x = float(i), y = 0.2f * float(i);
    stairs.quad({x, y, 2}, {x + 1, y, 2}, {x + 1, y, -2}, {x, y, -2});
    stairs.quad({x + 1, y, 2}, {x + 1, y + 0.2f, 2}, {x + 1, y + 0.2f, -2}, {x + 1, y, -2});
  }
  const Geometry ground = stairs.cook();
  // Pressed 1 mm into the riser, 0.1 mm into the tread.
  const Manifolds found = collide(ground, Box{{0.3f, 0.3f, 0.3f}}, {{2.701f, 0.6999f, 0.1f}, {}});
  ASSERT_NE(found.along({-1, 0, 0}, 1.0e-5f), nullptr);
  ASSERT_NE(found.along(kUp, 1.0e-5f), nullptr);
  EXPECT_NEAR(found.along({-1, 0, 0}, 1.0e-5f)->points[0].separation, -1.0e-3f, 1.0e-5f);
  // A little over the edge of a step, and 1 mm into its top: up, not back.
  const Manifolds over = collide(ground, Box{{0.3f, 0.3f, 0.3f}}, {{2.8f, 0.899f, 0.1f}, {}});
  ASSERT_EQ(over.count, 1);
  EXPECT_LT(length(over.all[0].normal - kUp), 1.0e-5f);
}

TEST(CollideMeshEdges, PlatesAndCapsulesTouchTheBorderOfASheet) {
  const Geometry sheet = flat_grid(1.0f, 0.25f).cook();
  // Beside the border at its height, pushed straight away from it.
  for (const AnyShape& shape :
       {AnyShape(Box{{0.3f, 0.3f, 0.3f}}), AnyShape(Sphere{0.3f}), AnyShape(Capsule{0.3f, 0.4f}),
        AnyShape(Cylinder{0.3f, 0.3f}), AnyShape(Box{{0.3f, 0.3f, 0.3f}, 0.1f})}) {
    const Manifolds found = collide(sheet, shape, {{1.299f, 0.01f, 0.1f}, {}});
    ASSERT_EQ(found.count, 1);
    EXPECT_LT(length(found.all[0].normal - Vec3{1, 0, 0}), 0.05f);
    EXPECT_NEAR(found.deepest(), -1.0e-3f, 2.0e-4f);
  }
  // Half over it: still up.
  const Manifolds half = collide(sheet, Box{{0.3f, 0.3f, 0.3f}}, {{1.1f, 0.299f, 0.1f}, {}});
  ASSERT_EQ(half.count, 1);
  EXPECT_LT(length(half.all[0].normal - kUp), 1.0e-6f);
  EXPECT_EQ(half.all[0].count, 4);
  for (int k = 0; k < 4; ++k) EXPECT_LE(half.all[0].points[k].position.x, 1.0f + 1.0e-5f);
}

TEST(CollideMeshEdges, PointyHillsTouchTheMiddleOfABox) {
  // One peak under the middle of a box, and a ridge under a plate.
  const Geometry peak =
      grid(2.0f, 0.5f, [](float x, float z) { return x == 0 && z == 0 ? 0.5f : 0.0f; }).cook();
  const Manifolds box = collide(peak, Box{{0.4f, 0.4f, 0.4f}}, {{0.1f, 0.895f, 0.05f}, {}});
  ASSERT_EQ(box.count, 1);
  EXPECT_LT(length(box.all[0].normal - kUp), 1.0e-5f);
  ASSERT_EQ(box.points(), 1);
  EXPECT_NEAR(box.all[0].points[0].separation, -5.0e-3f, 1.0e-5f);
  EXPECT_LT(length(box.all[0].points[0].position - Vec3{0, 0.4975f, 0}), 1.0e-4f);
  const Geometry ridge = grid(2.0f, 0.5f, [](float x, float) { return -0.7f * std::fabs(x); }).cook();
  for (const AnyShape& shape : {AnyShape(Box{{0.4f, 0.1f, 0.4f}}), AnyShape(Box{{0.4f, 0.1f, 0.4f}, 0.05f}),
                                AnyShape(Cylinder{0.4f, 0.1f})}) {
    const Manifolds plate = collide(ridge, shape, {{0.1f, 0.099f, 0.05f}, {}});
    ASSERT_EQ(plate.count, 1);
    EXPECT_LT(length(plate.all[0].normal - kUp), 1.0e-3f);
    // The two ends of the stretch of the ridge under the plate, and perhaps a vertex of the ridge between them.
    EXPECT_LE(plate.points(), 3);
    const float reach = plate.all[0].points[1].position.z - plate.all[0].points[0].position.z;
    EXPECT_GT(std::fabs(reach), 0.25f);
    for (int k = 0; k < plate.points(); ++k) {
      EXPECT_NEAR(plate.all[0].points[k].position.x, 0.0f, 1.0e-4f);
      EXPECT_LT(std::fabs(plate.all[0].points[k].position.z - 0.05f), 0.4f + 1.0e-4f);
      EXPECT_NEAR(plate.all[0].points[k].separation, -1.0e-3f, 2.0e-5f);
    }
  }
  // A capsule along the ridge, and one across it.
  const Quat along = from_axis_angle({1, 0, 0}, 0.5f * kPi), across = from_axis_angle({0, 0, 1}, 0.5f * kPi);
  const Manifolds lying = collide(ridge, Capsule{0.2f, 0.4f}, {{0, 0.199f, 0.05f}, along});
  ASSERT_EQ(lying.count, 1);
  EXPECT_LT(length(lying.all[0].normal - kUp), 1.0e-4f);
  EXPECT_LE(lying.points(), 3);
  EXPECT_GE(lying.points(), 2);
  const Manifolds crossing = collide(ridge, Capsule{0.2f, 0.4f}, {{0.05f, 0.199f, 0.05f}, across});
  ASSERT_EQ(crossing.count, 1);
  EXPECT_LT(length(crossing.all[0].normal - kUp), 1.0e-4f);
  EXPECT_EQ(crossing.points(), 1);
}

// ------------------------------------------------------------------------------------- pieces that are not joined

void expect_no_ghosts(const Geometry& ground, float from, float to) {
  const Quat on_side = from_axis_angle({0, 0, 1}, 0.5f * kPi);
  const struct {
    AnyShape shape;
    Quat lying;
    float height;
  } sliders[] = {{Box{{0.3f, 0.3f, 0.3f}}, {}, 0.3f},
                 {Sphere{0.3f}, {}, 0.3f},
                 {Capsule{0.2f, 0.3f}, on_side, 0.2f},
                 {Box{{0.3f, 0.05f, 0.3f}}, {}, 0.05f},
                 {Cylinder{0.3f, 0.3f}, {}, 0.3f}};
  Random random{79};
  for (const auto& slider : sliders) {
    for (float x = from; x < to; x += 0.013f) {
      const float gap = random.between(-3.0e-4f, 1.0e-4f);
      const Transform pose{{x, slider.height + gap, 0.2f * x}, from_axis_angle(kUp, 0.2f) * slider.lying};
      const Manifolds found = collide(ground, slider.shape, pose);
      for (int i = 0; i < found.count; ++i) {
        ASSERT_LT(length(found.all[i].normal - kUp), 1.0e-6f) << "x " << x << ", height " << slider.height;
      }
      ASSERT_EQ(found.count, 1);
      EXPECT_NEAR(found.deepest(), gap, 1.0e-5f);
    }
  }
}

TEST(CollideMeshEdges, TJunctionsAreNoEdges) {
  // Left of x = 0 large cells, right of it cells that do not match.
  Triangles floor;
  for (int i = -2; i < 2; ++i)
    floor.quad({-3, 0, 3.0f * float(i)}, {-3, 0, 3.0f * float(i + 1)}, {0, 0, 3.0f * float(i + 1)},
               {0, 0, 3.0f * float(i)});
  for (int i = -10; i < 10; ++i)
    floor.quad({0, 0, 0.7f * float(i)}, {0, 0, 0.7f * float(i + 1)}, {3, 0, 0.7f * float(i + 1)},
               {3, 0, 0.7f * float(i)});
  expect_no_ghosts(floor.cook(), -2.0f, 2.0f);
}

TEST(CollideMeshEdges, BlocksSideBySideAreNoEdges) {
  // Closed boxes laid side by side, sharing corners or a tenth of a millimetre apart.
  for (const float gap : {0.0f, 1.0e-4f}) {
    Triangles floor;
    for (int i = -2; i < 2; ++i) {
      add_box(floor, {1.5f * float(i), -1, -2}, {1.5f * float(i + 1) - gap, 0, 2});
    }
    expect_no_ghosts(floor.cook(), -2.0f, 2.0f);
  }
}

TEST(CollideMeshEdges, DoublesFromBehindAreNoEdges) {
  // Every triangle twice, once from each side, as some tools write double-sided surfaces.
  Triangles sheet = flat_grid(3.0f, 0.5f);
  const std::vector<std::uint32_t> front = sheet.indices;
  for (std::size_t i = 0; i < front.size(); i += 3) sheet.triangle(front[i], front[i + 2], front[i + 1]);
  expect_no_ghosts(sheet.cook(), -2.0f, 2.0f);
}

// A ball above a ridge of a fraction of a degree had no contact, because its foot was on neither side.
TEST(CollideMeshEdges, ABallRestsOnARidgeThatIsAllButFlat) {
  for (const float slope : {1.0e-4f, 4.0e-4f, 9.0e-4f, 3.0e-3f}) {
    Triangles roof;
    roof.quad({-1, -slope, -1}, {-1, -slope, 1}, {0, 0, 1}, {0, 0, -1});
    roof.quad({0, 0, -1}, {0, 0, 1}, {1, -slope, 1}, {1, -slope, -1});
    const Geometry ground = roof.cook();
    for (const float x : {0.0f, 0.3f, -0.6f}) {
      const Manifolds found = collide(ground, Sphere{1.0f}, {{x * slope, 1.001f, 0.1f}, {}});
      ASSERT_GE(found.count, 1) << slope << " " << x;
      EXPECT_NEAR(found.deepest(), 0.001f, 1.0e-5f) << slope << " " << x;
    }
  }
}

// A cone beside and below the border of a floor, with its tip above the plane of the floor, was thrown up by more than
// its height.
TEST(CollideMeshEdges, WhatIsBelowAndBesideAFloorIsNotTouched) {
  const Geometry floor = flat_grid(1.0f, 0.5f).cook();
  const Manifolds found = collide(floor, Cone{0.7f, 0.7f}, {{-0.19f, -0.63f, -1.2f}, {}});
  EXPECT_EQ(found.count, 0);
}

// A hull whose lowest corner hangs slightly beside a ridge was reported up to three times as far away, because only
// points over the face counted, and they are higher. No contact may be farther than the independent distance of the
// shapes. It may be closer, by the best separating axis, but not overlap.
TEST(CollideMeshEdges, ACornerBesideARidgeIsAsNearAsItIs) {
  Random random{83};
  int apart = 0, too_far = 0, overlapping = 0;
  for (int i = 0; i < 60000; ++i) {
    const float left = random.between(-2.5f, 0), right = random.between(-2.5f, 0);
    Triangles roof;
    roof.quad({-1, left, -1}, {-1, left, 1}, {0, 0, 1}, {0, 0, -1});
    roof.quad({0, 0, -1}, {0, 0, 1}, {1, right, 1}, {1, right, -1});
    const Geometry ground = roof.cook();
    std::vector<Vec3> points;
    for (int k = 0; k < 4 + i % 3 * 2; ++k)
      points.push_back(multiply_each({0.3f, i % 2 == 0 ? 0.01f : 0.3f, 0.3f}, random.direction()));
    const Result<Geometry> hull = cook_hull(points);
    if (!hull) continue;
    const Shape shape = make_shape(AnyShape(*hull));
    Transform pose{{random.between(-0.2f, 0.2f), 1.5f, random.between(-0.2f, 0.2f)}, random.rotation()};
    gyre::ClosestPair near;
    const double gap = double(random.between(0.001f, 0.006f));
    for (int k = 0; k < 8; ++k) {  // down, until they all but touch
      const PosedShape placed{&shape, DVec3(pose.position), to_double(pose.orientation)};
      near.distance = 1.0;
      if (!find_closest_points(make_shape(ground), placed, 10.0, near) || near.overlap || near.distance < gap)
        break;
      pose.position.y -= float(near.distance - 0.98 * gap);
    }
    if (near.overlap || near.distance > 0.009) continue;
    ++apart;
    const Manifolds found = collide(ground, *hull, pose, 0.012f);
    too_far += found.count == 0 || double(found.deepest()) > near.distance + 2.0e-4;
    overlapping += found.count > 0 && found.deepest() < 0.0f;
  }
  EXPECT_GT(apart, 50000);
  EXPECT_EQ(too_far, 0) << "of " << apart;
  EXPECT_EQ(overlapping, 0) << "of " << apart;
}

// A hull over the border of a slope was pushed out by half a metre: its lowest corner was behind the plane of the slope
// but beside it.
TEST(CollideMeshEdges, HullsBesideTheBorderOfASlopeAreNotPushed) {
  Random random{84};
  const Geometry ground = grid(0.2f, 0.1f, [](float x, float) { return x; }).cook();
  int apart = 0, pushed = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<Vec3> points;
    for (int k = 0; k < 6 + i % 5 * 5; ++k) points.push_back(0.4f * random.direction());
    const Result<Geometry> hull = cook_hull(points);
    if (!hull) continue;
    const Shape shape = make_shape(AnyShape(*hull));
    const Transform pose{
        {random.between(0.0f, 0.7f), random.between(0.0f, 0.9f), random.between(-0.2f, 0.2f)},
        random.rotation()};
    gyre::ClosestPair near;
    const PosedShape placed{&shape, DVec3(pose.position), to_double(pose.orientation)};
    if (!find_closest_points(make_shape(ground), placed, 10.0, near) || near.overlap ||
        near.distance < 1.0e-3)
      continue;
    ++apart;
    const Manifolds found = collide(ground, *hull, pose, 0.01f);
    pushed += found.count > 0 && found.deepest() < 0.0f;
  }
  EXPECT_EQ(pushed, 0) << "of " << apart;
  EXPECT_GT(apart, 2000);
}

// These had no contact: a short capsule beside a border, a cap over the corner of a patch, a ball on a sliver.
TEST(CollideMeshEdges, WhatIsNearHasAContact) {
  const Geometry slope = grid(0.2f, 0.1f, [](float x, float) { return 0.2f + x; }).cook();
  const Transform beside{{0.252823472f, 1.00780642f, -0.126857162f},
                         {-0.653578222f, 0.422708601f, 0.192262322f, 0.597652256f}};
  EXPECT_NEAR(collide(slope, Capsule{0.606344521f, 0.0173586588f}, beside, 0.0124741f).deepest(), 3.746e-3f,
              1e-4f);
  const Geometry patch = flat_grid(0.2f, 0.1f).cook();
  const Transform over{{0.929088831f, 0.86321491f, -0.618770003f}, {}};
  EXPECT_NEAR(collide(patch, Cylinder{0.894715488f, 0.845970392f}, over, 0.0246267f).deepest(), 0.0172445f,
              1e-4f);
  const Vec3 corners[] = {{0x1.433ed4p-5f, -0x1.4e468ep-7f, 0x1.2c9606p-5f},
                          {-0x1.813234p-6f, 0x1.8a81cep-9f, -0x1.54010ep-5f},
                          {0x1.9c55b6p-6f, -0x1.d81152p-8f, 0x1.366944p-6f}};
  const std::uint32_t indices[] = {0, 1, 2};
  const Geometry sliver = *cook_mesh({.vertices = corners, .indices = indices, .double_sided = true});
  const Transform above{{-0.1380869f, 0.96522212f, 0.229076236f}, {}};
  EXPECT_NEAR(collide(sliver, Sphere{1.0f}, above, 0.02f).deepest(), 6.005e-3f, 1e-4f);
}

// Seen edge-on, a sliver is an edge. Discs whose rim meets it had no contact, and a cylinder that it cuts was pushed
// along the sliver's normal, four times as far, at a point beyond its end.
TEST(CollideMeshEdges, CylindersTouchSliversAsEdges) {
  struct Case {
    Vec3 corners[3];  // both ends first
    Cylinder cylinder;
    Transform at;
    float separation;
  };
  const Case cases[] = {
      {{{0.564962149f, -0.428625584f, -0.176342726f},
        {-0.730284572f, -0.376855731f, 0.388075709f},
        {0.0507825315f, -0.399270326f, 0.0441740751f}},
       {0.959837675f, 0.0104458416f},
       {{-0.0627072155f, -0.0872581378f, 1.00810111f}, {0, 0, 0.707106829f, 0.707106829f}},
       0.0f},
      {{{0.54585886f, 0.590730309f, 0.337666988f},
        {-1.16465676f, -1.13869619f, 0.597917855f},
        {-0.619287848f, -0.587333798f, 0.514888287f}},
       {0.909708142f, 0.01079854f},
       {{-0.241531715f, -0.0143020088f, -0.187197387f},
        {0.278234512f, -0.402354479f, -0.182925984f, 0.852780461f}},
       0.0f},
      {{{-0.661617875f, 0.66235745f, -0.688928723f},
        {-0.950810313f, 0.0570253134f, 0.812283874f},
        {-0.729453504f, 0.52035284f, -0.336804092f}},
       {0.326767147f, 0.0101593286f},
       {{-0.618286073f, 0.338948905f, -0.175800562f}, {}},
       0.0f},
      {{{0.696284294f, 0.32273066f, 0.771111965f},
        {-0.770915747f, 0.276883602f, -0.99601078f},
        {-0.348062783f, 0.290079862f, -0.486741632f}},
       {0.632780969f, 0.932773471f},
       {{0.975222647f, 0.11822854f, -0.232839614f},
        {0.0645337328f, 0.556564212f, 0.819416046f, 0.120950654f}},
       -0.0631749f},
  };
  const std::uint32_t indices[] = {0, 1, 2};
  for (const Case& c : cases) {
    const Geometry sliver = *cook_mesh({.vertices = c.corners, .indices = indices, .double_sided = true});
    const Manifolds found = collide(sliver, c.cylinder, c.at, 0.02f * c.cylinder.radius);
    EXPECT_EQ(found.count, 1);
    EXPECT_NEAR(found.deepest(), c.separation, 1e-5f);
    // The points on the sliver lie between its ends.
    const Vec3 along = c.corners[1] - c.corners[0];
    const LocalManifold& m = found.all[0];
    for (int i = 0; i < m.count; ++i) {
      const Vec3 way = m.points[i].position - 0.5f * m.points[i].separation * m.normal - c.corners[0];
      EXPECT_LT(length(cross(way, along)), 0.01f * length_squared(along));
      EXPECT_GT(dot(way, along), 0.0f);
      EXPECT_LT(dot(way, along), length_squared(along));
    }
  }
}

// Needles and plates over steps and slopes counted as overlapping and were pushed out by decimetres.
TEST(CollideMeshEdges, ThinHullsThatAreApartAreNotPushed) {
  Random random{82};
  const Geometry ground =
      grid(0.2f, 0.1f, [&](float x, float) { return 0.03f * float(int(10.0f * x + 2.5f) / 2); }).cook();
  int apart = 0, pushed = 0;
  for (int i = 0; i < 20000; ++i) {
    const float thin = i % 2 == 0 ? 2.0e-4f : 2.0e-6f;
    std::vector<Vec3> points;
    for (int k = 0; k < 4 + i % 5 * 5; ++k)
      points.push_back(multiply_each({0.4f, thin, i % 3 == 0 ? 0.4f : 10.0f * thin}, random.direction()));
    const Result<Geometry> hull = cook_hull(points);
    if (!hull) continue;
    const Shape shape = make_shape(AnyShape(*hull));
    Transform pose{{random.between(-0.2f, 0.2f), 1.0f, random.between(-0.2f, 0.2f)}, random.rotation()};
    gyre::ClosestPair near;
    for (int k = 0; k < 8; ++k) {  // down, until they all but touch
      const PosedShape placed{&shape, DVec3(pose.position), to_double(pose.orientation)};
      near.distance = 1.0;  // beside the ground there is nothing
      if (!find_closest_points(make_shape(ground), placed, 10.0, near)) break;
      if (near.overlap || near.distance < 2.0e-4) break;
      pose.position.y -= float(near.distance - 1.0e-4);
    }
    if (near.overlap || near.distance > 0.008) continue;
    ++apart;
    const Manifolds found = collide(ground, *hull, pose, 0.008f);
    pushed += found.count > 0 && found.deepest() < -4.0e-4f;
  }
  EXPECT_EQ(pushed, 0) << "of " << apart;
  EXPECT_GT(apart, 5000);
}

}  // namespace
}  // namespace gyre::manifold_mesh_edges_test
