// Convex shapes against meshes and height fields: no ghost collisions, and the right contacts where the surface has edges.
#include "geometry/manifold_mesh/manifold_mesh.h"

#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::manifold_mesh_test {
namespace {

using namespace test;

// ------------------------------------------------------------------------------------------------------- flat ground

struct Slider {
  AnyShape shape;
  Quat lying;
  float height;  // of the origin when it touches
  int points;
};

std::vector<Slider> sliders() {
  const Quat on_side = from_axis_angle({0, 0, 1}, 0.5f * kPi);
  return {{Box{{0.5f, 0.5f, 0.5f}}, {}, 0.5f, 4},   {Sphere{0.5f}, {}, 0.5f, 1},
          {Capsule{0.3f, 0.5f}, on_side, 0.3f, 2},  {Capsule{0.3f, 0.5f}, {}, 0.8f, 1},
          {Box{{0.5f, 0.05f, 0.5f}}, {}, 0.05f, 4}, {Box{{0.5f, 0.5f, 0.5f}, 0.1f}, {}, 0.5f, 4},
          {Cylinder{0.4f, 0.5f}, {}, 0.5f, 4},      {Cylinder{0.4f, 0.5f}, on_side, 0.4f, 2}};
}

// One step after the other over the ground, sunk or hovering a little, turned about the vertical.
void slide(const Geometry& ground, const Slider& slider, float height_of_ground = 0.0f) {
  Random random{41};
  for (int step = 0; step < 120; ++step) {
    const float t = float(step) / 60.0f;
    const float gap =
        step % 3 == 0 ? -1.0e-3f * random.unit() : (step % 3 == 1 ? -1.0e-6f : 0.01f * random.unit());
    const Transform pose{{-7.0f + 7.3f * t, height_of_ground + slider.height + gap, -3.0f + 1.7f * t},
                         from_axis_angle(kUp, 0.1f * t) * slider.lying};
    const Manifolds found = collide(ground, slider.shape, pose);
    ASSERT_EQ(found.count, 1) << "step " << step;
    EXPECT_LT(length(found.all[0].normal - kUp), 1.0e-6f) << "step " << step;
    EXPECT_EQ(found.all[0].count, slider.points) << "step " << step;
    for (int k = 0; k < found.all[0].count; ++k) {
      EXPECT_NEAR(found.all[0].points[k].separation, gap, 1.0e-5f) << "step " << step;
      EXPECT_NEAR(found.all[0].points[k].position.y, height_of_ground + 0.5f * gap, 1.0e-5f);
    }
  }
}

TEST(CollideMesh, SlidesOverFlatGridsWithoutGhosts) {
  for (const float cell : {1.0f, 0.25f, 0.37f, 0.05f}) {
    const Geometry ground = test::flat_grid(12.0f, cell).cook();
    int index = 0;
    for (const Slider& slider : sliders()) {
      SCOPED_TRACE(testing::Message() << "cell " << cell << ", slider " << index++);
      slide(ground, slider);
    }
  }
}

TEST(CollideMesh, SlidesOverTiltedGridsWithoutGhosts) {
  Random random{43};
  for (int round = 0; round < 12; ++round) {
    Triangles tilted = test::flat_grid(12.0f, round % 2 == 0 ? 0.37f : 1.0f);
    const Quat turn = random.rotation();
    for (Vec3& v : tilted.vertices) v = rotate(turn, v);
    const Geometry ground = tilted.cook();
    const Vec3 normal = rotate(turn, kUp);
    int index = 0;
    for (const Slider& slider : sliders()) {
      for (int step = 0; step < 40; ++step) {
        SCOPED_TRACE(testing::Message() << "round " << round << ", slider " << index << ", step " << step);
        const float gap = random.between(-1.0e-3f, 0.01f);
        const Transform level{{random.between(-8, 8), slider.height + gap, random.between(-8, 8)},
                              from_axis_angle(kUp, random.between(-3, 3)) * slider.lying};
        const Manifolds found = collide(ground, slider.shape, Transform{{}, turn} * level);
        ASSERT_EQ(found.count, 1);
        EXPECT_LT(length(found.all[0].normal - normal), 2.0e-6f);
        EXPECT_EQ(found.all[0].count, slider.points);
        EXPECT_NEAR(found.deepest(), gap, 1.0e-5f);
      }
      ++index;
    }
  }
}

TEST(CollideMesh, PointsKeepTheirNamesWhileSliding) {
  const Geometry ground = test::flat_grid(12.0f, 0.37f).cook();
  for (const AnyShape& shape : {AnyShape(Box{{0.5f, 0.5f, 0.5f}}), AnyShape(Sphere{0.5f})}) {
    Manifolds before = collide(ground, shape, {{-5.0f, 0.4999f, -5.0f}, {}});
    for (int step = 1; step < 100; ++step) {
      const Manifolds now = collide(ground, shape, {{-5.0f + 0.08f * float(step), 0.4999f, -5.0f}, {}});
      ASSERT_EQ(now.points(), before.points());
      for (int k = 0; k < now.all[0].count; ++k) {
        bool kept = false;
        for (int j = 0; j < now.all[0].count; ++j) {
          kept = kept || now.all[0].points[k].feature == before.all[0].points[j].feature;
        }
        EXPECT_TRUE(kept);
      }
      before = now;
    }
  }
}

TEST(CollideMesh, FlatGroundEqualsAPlane) {
  const Geometry ground = test::flat_grid(8.0f, 0.37f).cook();
  const AnyShape box = Box{{0.5f, 0.4f, 0.3f}};
  const Shape plane = make_shape(Plane{});
  Random random{47};
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(i);
    // A third of them lie nearly flat.
    Transform pose{{random.between(-5, 5), 0.0f, random.between(-5, 5)}, random.rotation()};
    if (i % 3 == 0)
      pose.orientation = from_rotation_vector({random.between(-0.02f, 0.02f), random.between(-3, 3), 0.0f});
    pose.position.y = random.between(-0.05f, 0.01f) - lowest_point(box, pose);
    LocalManifold want;
    collide_plane(plane, make_shape(box), pose, kMargin, want);
    const Manifolds found = collide(ground, box, pose);
    ASSERT_GT(want.count, 0);
    ASSERT_EQ(found.count, 1);
    EXPECT_LT(length(found.all[0].normal - kUp), 1.0e-6f);
    float deepest = 1.0f;
    for (int k = 0; k < want.count; ++k) deepest = min(deepest, want.points[k].separation);
    EXPECT_NEAR(found.deepest(), deepest, 1.0e-5f);
    // Every point of ours is a corner of the box, with its own height.
    for (int k = 0; k < found.all[0].count; ++k) {
      const ManifoldPoint& p = found.all[0].points[k];
      EXPECT_NEAR(2.0f * p.position.y, p.separation, 1.0e-5f);
      const Vec3 local = absolute(inverse_times(pose, p.position - 0.0f * kUp + 0.5f * p.separation * kUp));
      EXPECT_LT(length(local - Vec3{0.5f, 0.4f, 0.3f}), 1.0e-4f);
    }
    if (i % 3 != 0) continue;
    ASSERT_EQ(found.all[0].count, want.count);
    for (int k = 0; k < want.count; ++k) {
      float nearest = 1.0f;
      for (int j = 0; j < want.count; ++j) {
        nearest = min(nearest, distance(found.all[0].points[j].position, want.points[k].position));
      }
      EXPECT_LT(nearest, 1.0e-4f);
    }
  }
}

TEST(CollideMesh, EveryKindAtAnyTiltIsPushedUpByFlatGround) {
  Random random{53};
  const std::vector<AnyShape> kinds = all_kinds(random);
  for (const float cell : {1.0f, 0.2f}) {
    const Geometry ground = test::flat_grid(5.0f, cell).cook();
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      for (int i = 0; i < 150; ++i) {
        SCOPED_TRACE(testing::Message() << "cell " << cell << ", kind " << kind << ", pose " << i);
        Transform pose{{random.between(-3, 3), 0.0f, random.between(-3, 3)}, random.rotation()};
        const float gap = i % 4 == 0 ? random.between(-0.2f, 0.0f) : random.between(-0.01f, 0.015f);
        pose.position.y = gap - lowest_point(kinds[kind], pose);
        const Manifolds found = collide(ground, kinds[kind], pose);
        ASSERT_EQ(found.count, 1);
        EXPECT_LT(length(found.all[0].normal - kUp), 1.0e-6f);
        // Among more than four points one may stand for a deeper one by its name.
        EXPECT_NEAR(found.deepest(), gap, kind < 5 ? 1.0e-5f : 1.0e-3f);
      }
    }
  }
}

TEST(CollideMesh, DeepBodiesLeaveThroughTheFront) {
  Random random{59};
  const std::vector<AnyShape> kinds = all_kinds(random);
  const Geometry ground = test::flat_grid(5.0f, 0.3f).cook();
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE(testing::Message() << "kind " << kind << ", pose " << i);
      Transform pose{{random.between(-3, 3), 0.0f, random.between(-3, 3)}, random.rotation()};
      const Transform turned{{}, from_axis_angle({1, 0, 0}, kPi) * pose.orientation};
      const float low = lowest_point(kinds[kind], pose), high = -lowest_point(kinds[kind], turned);
      // Two thirds of the body, and its middle, below the ground.
      const float gap = -0.67f * (high - low);
      pose.position.y = gap - low;
      const Manifolds found = collide(ground, kinds[kind], pose);
      ASSERT_GE(found.count, 1);
      for (int m = 0; m < found.count; ++m) EXPECT_LT(length(found.all[m].normal - kUp), 1.0e-6f);
      EXPECT_NEAR(found.deepest(), gap, kind < 5 ? 1.0e-5f : 1.0e-3f);
      // All of it below: it is behind the surface, which has no back.
      pose.position.y = -high - 0.01f;
      EXPECT_EQ(collide(ground, kinds[kind], pose).count, 0);
    }
  }
}

TEST(CollideMesh, DoubleSidedGroundPushesTowardsTheSideOfTheMiddle) {
  Random random{61};
  const std::vector<AnyShape> kinds = all_kinds(random);
  const Geometry sheet = test::flat_grid(5.0f, 0.3f).cook(true);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE(testing::Message() << "kind " << kind << ", pose " << i);
      Transform pose{{random.between(-3, 3), 0.0f, random.between(-3, 3)}, random.rotation()};
      const float gap = random.between(-0.02f, 0.01f);
      pose.position.y = gap - lowest_point(kinds[kind], pose);
      const Manifolds above = collide(sheet, kinds[kind], pose);
      ASSERT_EQ(above.count, 1);
      EXPECT_EQ(above.all[0].normal, kUp);
      // Mirrored through the ground: turned half about x.
      const Quat half = from_axis_angle({1, 0, 0}, kPi);
      const Transform below{rotate(half, pose.position), half * pose.orientation};
      const Manifolds found = collide(sheet, kinds[kind], below);
      ASSERT_EQ(found.count, 1);
      EXPECT_LT(length(found.all[0].normal + kUp), 1.0e-6f);
      EXPECT_NEAR(found.deepest(), gap, kind < 5 ? 2.0e-5f : 1.0e-3f);
    }
  }
}

TEST(CollideMesh, HugeFloorsAndTinyBodies) {
  Triangles floor;
  floor.quad({-1e6f, 0, -1e6f}, {-1e6f, 0, 1e6f}, {1e6f, 0, 1e6f}, {1e6f, 0, -1e6f});
  const Geometry huge = floor.cook(), wide = flat_grid(500.0f, 10.0f).cook();
  Random random{67};
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    // Half of them right over the diagonal.
    const float reach = i % 4 < 2 ? 1.0e5f : 3.0f, x = random.between(-reach, reach);
    const float z = i % 2 == 0 ? x : random.between(-reach, reach);
    const Quat turn = from_axis_angle(kUp, random.between(-3, 3));
    const Manifolds box = collide(huge, Box{{0.5f, 0.5f, 0.5f}}, {{x, 0.4999f, z}, turn});
    ASSERT_EQ(box.count, 1);
    EXPECT_EQ(box.all[0].normal, kUp);
    EXPECT_EQ(box.points(), 4);
    EXPECT_NEAR(box.deepest(), -1.0e-4f, 1.0e-6f);
    const float size = i % 2 == 0 ? 1.0e-3f : 1.0e-2f;
    const Manifolds tiny =
        collide(wide, Box{{size, size, size}},
                {{random.between(-499, 499), 0.999f * size, random.between(-499, 499)}, turn}, 0.02f * size);
    ASSERT_EQ(tiny.count, 1);
    EXPECT_EQ(tiny.points(), 4);
    EXPECT_NEAR(tiny.deepest(), -1.0e-3f * size, 1.0e-5f * size);
  }
}

TEST(CollideMesh, PosesThatAreNotFiniteTouchNothing) {
  const Geometry ground = flat_grid(5.0f, 1.0f).cook();
  Random random{69};
  for (const AnyShape& shape : all_kinds(random)) {
    for (const float bad : {__builtin_nanf(""), __builtin_huge_valf(), 1.0e30f}) {
      EXPECT_EQ(collide(ground, shape, {{bad, 0, 0}, {}}).count, 0);
      EXPECT_EQ(collide(ground, shape, {{0, bad, 0}, {}}).count, 0);
      EXPECT_EQ(collide(ground, shape, {{bad, bad, bad}, {}}).count, 0);
    }
  }
}

TEST(CollideMesh, TheSameQuestionHasTheSameAnswer) {
  Random random{70};
  const Geometry ground = grid(3.0f, 0.3f, [&](float, float) { return random.between(0.0f, 0.2f); }).cook();
  for (const AnyShape& shape : all_kinds(random)) {
    for (int i = 0; i < 20; ++i) {
      Transform pose{{random.between(-2, 2), 0.0f, random.between(-2, 2)}, random.rotation()};
      pose.position.y = 0.1f - lowest_point(shape, pose);
      const Manifolds a = collide(ground, shape, pose), b = collide(ground, shape, pose);
      ASSERT_EQ(a.count, b.count);
      for (int m = 0; m < a.count; ++m) {
        EXPECT_EQ(a.all[m].normal, b.all[m].normal);
        ASSERT_EQ(a.all[m].count, b.all[m].count);
        for (int k = 0; k < a.all[m].count; ++k) {
          EXPECT_EQ(a.all[m].points[k].position, b.all[m].points[k].position);
          EXPECT_EQ(a.all[m].points[k].feature, b.all[m].points[k].feature);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gyre::manifold_mesh_test
