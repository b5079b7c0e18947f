// Support points and facing features against plain searches over points of the surface, and the guarantees for
// manifolds: persistent names, corners in order, and the lowest point always among them.
#include "geometry/shape/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace gyre::support_test {
namespace {

struct Random {
  std::mt19937 engine{99};
  float operator()(float low = -1.0f, float high = 1.0f) {
    return low + (high - low) * (float(engine() >> 8) / 16777216.0f);
  }
  Vec3 direction() {
    for (;;) {
      const float x = (*this)(), y = (*this)(), z = (*this)();
      const Vec3 p{x, y, z};
      if (length_squared(p) > 0.01f && length_squared(p) < 1.0f) return normalized(p);
    }
  }
};

Geometry test_hull() {
  Random random;
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) points.push_back(multiply_each({1.0f, 0.6f, 0.8f}, random.direction()));
  return *cook_hull(points);
}

struct Case {
  const char* name;
  AnyShape shape;
  std::vector<Vec3> extremes;  // a dense choice of points that the core spans
};

std::vector<Vec3> circle(float radius, float y) {
  std::vector<Vec3> points;
  for (int i = 0; i < 3600; ++i) {
    const double a = 2 * kPiDouble * i / 3600;
    points.push_back({float(double(radius) * std::cos(a)), y, float(double(radius) * std::sin(a))});
  }
  return points;
}

std::vector<Case> convex_cases() {
  static const Geometry hull = test_hull();
  std::vector<Case> cases;
  cases.push_back({"sphere", Sphere{0.4f}, {{0, 0, 0}}});
  cases.push_back({"capsule", Capsule{0.3f, 0.7f}, {{0, 0.7f, 0}, {0, -0.7f, 0}}});
  for (const float rounding : {0.0f, 0.125f, 0.25f}) {
    Case box{"box", Box{{0.5f, 0.25f, 1.0f}, rounding}, {}};
    for (int i = 0; i < 8; ++i) {
      const Vec3 e{0.5f - rounding, 0.25f - rounding, 1.0f - rounding};
      box.extremes.push_back({(i & 1) ? e.x : -e.x, (i & 2) ? e.y : -e.y, (i & 4) ? e.z : -e.z});
    }
    cases.push_back(box);
  }
  Case cylinder{"cylinder", Cylinder{0.5f, 0.8f}, circle(0.5f, 0.8f)};
  const std::vector<Vec3> lower = circle(0.5f, -0.8f);
  cylinder.extremes.insert(cylinder.extremes.end(), lower.begin(), lower.end());
  cases.push_back(cylinder);
  for (const float radius : {0.2f, 0.5f, 2.0f}) {
    Case cone{"cone", Cone{radius, 0.6f}, circle(radius, -0.6f)};
    cone.extremes.push_back({0, 0.6f, 0});
    cases.push_back(cone);
  }
  const HullView view = view_hull(hull);
  cases.push_back({"hull", hull, {view.vertices.begin(), view.vertices.end()}});
  return cases;
}

float highest(const std::vector<Vec3>& points, Vec3 d) {
  float best = -1e30f;
  for (const Vec3& p : points) best = std::max(best, dot(p, d));
  return best;
}

TEST(Support, IsThatOfAPlainSearch) {
  Random random;
  for (const Case& test : convex_cases()) {
    const Shape shape = make_shape(test.shape);
    for (int i = 0; i < 300; ++i) {
      Vec3 d = random.direction();
      if (i < 6)
        d = {i / 2 == 0 ? 1.0f - 2.0f * float(i % 2) : 0, i / 2 == 1 ? 1.0f - 2.0f * float(i % 2) : 0,
             i / 2 == 2 ? 1.0f - 2.0f * float(i % 2) : 0};
      EXPECT_NEAR(dot(support(shape, d), d), highest(test.extremes, d), 2e-6f) << test.name;
      // Any length.
      EXPECT_NEAR(distance(support(shape, 1e-12f * d), support(shape, d)), 0.0f, 2e-6f) << test.name;
      EXPECT_NEAR(distance(support(shape, 1e12f * d), support(shape, d)), 0.0f, 2e-6f) << test.name;
    }
    EXPECT_TRUE(is_finite(support(shape, {}))) << test.name;
    EXPECT_LE(length(support(shape, {})), outer_radius(shape, {}) * 1.000001f) << test.name;
  }
}

TEST(Support, CoreRadius) {
  EXPECT_EQ(core_radius(make_shape(Sphere{0.4f})), 0.4f);
  EXPECT_EQ(core_radius(make_shape(Capsule{0.3f, 1.0f})), 0.3f);
  EXPECT_EQ(core_radius(make_shape(Box{{1, 1, 1}, 0.1f})), 0.1f);
  EXPECT_EQ(core_radius(make_shape(Cylinder{0.5f, 1.0f})), 0.0f);
  EXPECT_EQ(core_radius(make_shape(Cone{0.5f, 1.0f})), 0.0f);
}

// Invariants of every feature of every shape and direction.
void expect_feature(const Case& test, const Shape& shape, Vec3 d) {
  SCOPED_TRACE(test.name);
  FacePolygon face;
  ASSERT_EQ(support_face(shape, d, face), face.count);
  ASSERT_GE(face.count, 1);
  ASSERT_LE(face.count, kMaxFaceVertices);
  EXPECT_LT(face.feature, 256u);
  EXPECT_NEAR(length(face.normal), 1.0f, 1e-6f);
  std::set<int> ids;
  float top = -1e30f;
  for (int i = 0; i < face.count; ++i) {
    EXPECT_TRUE(ids.insert(face.ids[i]).second) << "one name for two corners";
    const Vec3 v = face.vertices[i];
    // On the surface of the core, in the plane of the feature.
    EXPECT_NEAR(dot(v, face.normal), highest(test.extremes, face.normal), face.count >= 2 ? 3e-6f : 10.0f);
    top = std::max(top, dot(v, d));
  }
  // The lowest point is one of the corners, or on the face of a rim that hardly leans (see kSteadyLean).
  EXPECT_NEAR(top, dot(support(shape, d), d), 2e-4f);
  if (face.count == 2) {
    EXPECT_NEAR(dot(face.vertices[1] - face.vertices[0], face.normal), 0.0f, 2e-6f);
  }
  for (int i = 0; i < face.count && face.count >= 3; ++i) {
    const Vec3 a = face.vertices[i], b = face.vertices[(i + 1) % face.count],
               c = face.vertices[(i + 2) % face.count];
    EXPECT_GT(dot(cross(b - a, c - b), face.normal), 0.0f) << "not counter-clockwise and convex";
  }
}

TEST(Support, FeaturesOfAllShapes) {
  Random random;
  for (const Case& test : convex_cases()) {
    const Shape shape = make_shape(test.shape);
    for (int i = 0; i < 500; ++i) expect_feature(test, shape, random.direction());
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {1.0f, -1.0f}) {
        const Vec3 d{axis == 0 ? sign : 0.0f, axis == 1 ? sign : 0.0f, axis == 2 ? sign : 0.0f};
        expect_feature(test, shape, d);
        for (int i = 0; i < 50; ++i) expect_feature(test, shape, normalized(d + 1e-3f * random.direction()));
      }
    }
  }
}

TEST(Support, BoxFacesAndTheirFlatForms) {
  FacePolygon face;
  const Shape box = make_shape(Box{{1, 2, 3}});
  EXPECT_EQ(support_face(box, {0.1f, -0.9f, 0.2f}, face), 4);
  EXPECT_EQ(face.normal, (Vec3{0, -1, 0}));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(face.vertices[i].y, -2.0f);
  // All rounding in y and z: a segment along x, as of a capsule.
  const Shape rod = make_shape(Box{{2, 0.5f, 0.5f}, 0.5f});
  EXPECT_EQ(support_face(rod, {0.1f, 0.6f, 0.8f}, face), 2);
  EXPECT_NEAR(distance(face.normal, Vec3{0, 0.6f, 0.8f}), 0.0f, 1e-6f);
  EXPECT_EQ(support_face(rod, {1, 0.1f, 0}, face), 1);
  EXPECT_EQ(face.vertices[0], (Vec3{1.5f, 0, 0}));
  const Shape ball = make_shape(Box{{0.5f, 0.5f, 0.5f}, 0.5f});
  EXPECT_EQ(support_face(ball, {0.6f, 0.8f, 0}, face), 1);
  EXPECT_EQ(face.normal, normalized(Vec3{0.6f, 0.8f, 0}));
}

TEST(Support, StandingCylinderKeepsItsCorners) {
  const Shape cylinder = make_shape(Cylinder{0.5f, 1.0f});
  FacePolygon still;
  ASSERT_EQ(support_face(cylinder, {0, -1, 0}, still), 8);
  Random random;
  for (int i = 0; i < 100; ++i) {
    FacePolygon leaning;
    const Vec3 d = normalized(Vec3{2e-4f * random(), -1, 2e-4f * random()});
    ASSERT_EQ(support_face(cylinder, d, leaning), 8);
    EXPECT_EQ(leaning.feature, still.feature);
    for (int k = 0; k < 8; ++k) {
      EXPECT_EQ(leaning.vertices[k], still.vertices[k]);
      EXPECT_EQ(leaning.ids[k], still.ids[k]);
    }
  }
}

TEST(Support, TiltedCylinderStandsOnItsLowestPoint) {
  const Shape cylinder = make_shape(Cylinder{0.5f, 1.0f});
  FacePolygon last;
  // Rolls around on its rim, tilted by 10 degrees: the corners keep their places, the lowest point wanders.
  for (int i = 0; i < 720; ++i) {
    const double a = 2 * kPiDouble * i / 720;
    const Vec3 d = normalized(Vec3{0.176f * float(std::cos(a)), -1, 0.176f * float(std::sin(a))});
    FacePolygon face;
    support_face(cylinder, d, face);
    ASSERT_TRUE(face.count == 8 || face.count == 9);
    float top = -1e30f;
    for (int k = 0; k < face.count; ++k) top = std::max(top, dot(face.vertices[k], d));
    EXPECT_NEAR(top, dot(support(cylinder, d), d), 1e-6f);
    for (int k = 0; k < face.count && i > 0; ++k) {
      for (int j = 0; j < last.count; ++j) {
        // No name jumps: half a degree of rolling moves a corner by at most the 7 degrees that it may be drawn along.
        if (last.ids[j] == face.ids[k] && face.ids[k] < 8) {
          EXPECT_LT(distance(last.vertices[j], face.vertices[k]), 0.5f * 0.13f);
        }
      }
    }
    last = face;
  }
}

TEST(Support, LyingCylinderRestsOnALine) {
  const Shape cylinder = make_shape(Cylinder{0.5f, 1.0f});
  for (int i = 0; i < 100; ++i) {
    const double a = 0.1 * i;
    const Vec3 d{float(std::cos(a)), 0.01f, float(std::sin(a))};
    FacePolygon face;
    ASSERT_EQ(support_face(cylinder, d, face), 2);
    EXPECT_EQ(face.vertices[0].x, face.vertices[1].x);
    EXPECT_EQ(face.vertices[0].z, face.vertices[1].z);
    EXPECT_EQ(face.vertices[1].y - face.vertices[0].y, 2.0f);
    // The names last while it rolls.
    EXPECT_EQ(face.ids[0], 32);
    EXPECT_EQ(face.ids[1], 33);
  }
}

TEST(Support, ConeStandsLiesAndBalances) {
  const Shape cone = make_shape(Cone{0.5f, 0.75f});
  FacePolygon face;
  EXPECT_EQ(support_face(cone, {0, -1, 0}, face), 8);
  EXPECT_EQ(support_face(cone, {0, 1, 0}, face), 1);
  EXPECT_EQ(face.vertices[0], (Vec3{0, 0.75f, 0}));
  const Vec3 mantle = normalized(Vec3{1.5f, 0.5f, 0});
  ASSERT_EQ(support_face(cone, mantle, face), 2);
  EXPECT_NEAR(distance(face.normal, mantle), 0.0f, 1e-6f);
  EXPECT_NEAR(dot(face.vertices[0], mantle), dot(face.vertices[1], mantle), 1e-6f);
}

TEST(Support, HullFacesWithManyCornersAreThinned) {
  std::vector<Vec3> points;
  for (int i = 0; i < 100; ++i) {
    const double a = 2 * kPiDouble * i / 100;
    for (const float y : {-1.0f, 1.0f}) points.push_back({float(std::cos(a)), y, float(std::sin(a))});
  }
  const Geometry hull = *cook_hull(points);
  FacePolygon face;
  ASSERT_EQ(support_face(make_shape(hull), {0, 1, 0}, face), kMaxFaceVertices);
  std::set<int> ids(face.ids, face.ids + face.count);
  EXPECT_EQ(int(ids.size()), kMaxFaceVertices);
  for (int i = 0; i < face.count; ++i) {
    EXPECT_EQ(face.vertices[i].y, 1.0f);
    // Evenly around.
    EXPECT_LT(distance(face.vertices[i], face.vertices[(i + 1) % face.count]), 0.26f);
  }
}

}  // namespace
}  // namespace gyre::support_test
