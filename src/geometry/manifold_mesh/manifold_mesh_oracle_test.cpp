// Contacts with rough ground against GJK over every triangle: no contact is missed or invented, and following the
// contacts leads out.
#include "geometry/distance/gjk.h"
#include "geometry/manifold_mesh/manifold_mesh.h"
#include "geometry/shape/cooked.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::manifold_mesh_oracle_test {
namespace {

using namespace test;

// The triangles of a mesh as flat hulls, each around its own first corner.
class Oracle {
 public:
  explicit Oracle(const Mesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      const TriangleView view = view_triangle(mesh, t);
      Hull hull;
      for (const Vec3 v : view.v) hull.vertices.push_back(v - view.v[0]);
      for (int i = 0; i < Hull::kPad; ++i) {
        const Vec3 v = hull.vertices[std::size_t(min(i, 2))];
        hull.x.push_back(v.x);
        hull.y.push_back(v.y);
        hull.z.push_back(v.z);
      }
      const Aabb box = bounds(view);
      hull.box = {box.low - view.v[0], box.high - view.v[0]};
      hulls_.push_back(std::move(hull));
      places_.push_back(view.v[0]);
    }
  }

  // Distance of the surfaces; -1 if the core of the shape meets a triangle.
  float distance(const Shape& shape, const Transform& pose) const {
    double best = 1.0e9;
    for (std::size_t i = 0; i < hulls_.size(); ++i) {
      Shape triangle;
      triangle.kind = ShapeKind::hull;
      triangle.hull = &hulls_[i];
      const CorePair pair(triangle, shape, {pose.position - places_[i], pose.orientation});
      const CoreDistance found = core_distance(pair, best + 1.0, kUp);
      if (found.overlap) return -1.0f;
      best = min(best, found.distance);
    }
    return float(best) - core_radius(shape);
  }

  // Lowers the shape until it is `target` above the surface. Returns the distance reached.
  float lower(const Shape& shape, Transform& pose, float target) const {
    float found = 0.0f;
    for (int i = 0; i < 60; ++i) {
      found = distance(shape, pose);
      if (absolute(found - target) < 1.0e-5f) break;
      pose.position.y -= found < 0.0f ? -0.003f : found - target;
    }
    return found;
  }

 private:
  std::vector<Hull> hulls_;
  std::vector<Vec3> places_;
};

Geometry rough_ground(Random& random, float roughness) {
  return grid(1.6f, 0.4f, [&](float, float) { return random.between(0.0f, roughness); }).cook();
}

TEST(CollideMeshOracle, FindsTheNearestPointOfEveryKind) {
  Random random{101};
  const std::vector<AnyShape> kinds = all_kinds(random);
  for (const float roughness : {0.05f, 0.3f}) {
    const Geometry ground = rough_ground(random, roughness);
    const Oracle oracle(*ground.data()->mesh);
    int inexact = 0, total = 0;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const Shape shape = make_shape(kinds[kind]);
      for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", kind " << kind << ", pose " << i);
        Transform pose{{random.between(-0.6f, 0.6f), 2.0f, random.between(-0.6f, 0.6f)}, random.rotation()};
        const float want = oracle.lower(shape, pose, random.between(0.0f, 0.018f));
        if (want <= 0.0f || want > 0.019f) continue;
        const Manifolds found = collide(ground, kinds[kind], pose);
        ASSERT_GE(found.count, 1);
        // An axis search of polyhedra may report corners beside edges slightly closer than they are, never by much.
        EXPECT_GT(found.deepest(), want - 3.0e-3f);
        inexact += absolute(found.deepest() - want) > 1.0e-4f;
        ++total;
      }
    }
    EXPECT_GT(total, 300);
    EXPECT_LT(inexact, total / 50);
  }
}

TEST(CollideMeshOracle, FollowingTheContactsLeadsOut) {
  Random random{103};
  const std::vector<AnyShape> kinds = all_kinds(random);
  for (const float roughness : {0.05f, 0.3f}) {
    const Geometry ground = rough_ground(random, roughness);
    const Oracle oracle(*ground.data()->mesh);
    int left = 0, total = 0;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const Shape shape = make_shape(kinds[kind]);
      for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", kind " << kind << ", pose " << i);
        Transform pose{{random.between(-0.6f, 0.6f), 2.0f, random.between(-0.6f, 0.6f)}, random.rotation()};
        oracle.lower(shape, pose, 1.0e-4f);
        const float sink = random.between(1.0e-3f, 0.1f);
        pose.position.y -= sink;
        const Vec3 start = pose.position;
        int step = 0;
        for (; step < 60; ++step) {
          const Manifolds found = collide(ground, kinds[kind], pose);
          const LocalManifold* deepest = nullptr;
          float separation = -1.0e-4f;
          for (int m = 0; m < found.count; ++m) {
            for (int k = 0; k < found.all[m].count; ++k) {
              if (found.all[m].points[k].separation >= separation) continue;
              separation = found.all[m].points[k].separation;
              deepest = &found.all[m];
            }
          }
          if (deepest == nullptr) break;
          pose.position = pose.position - separation * deepest->normal;
        }
        EXPECT_LT(step, 60);
        EXPECT_LT(distance(pose.position, start), 4.0f * sink);
        pose.position.y += 2.0e-3f;
        left += oracle.distance(shape, pose) < 0.0f;
        ++total;
      }
    }
    EXPECT_LE(left, total / 100);
  }
}

}  // namespace
}  // namespace gyre::manifold_mesh_oracle_test
