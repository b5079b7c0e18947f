// A triangle that is rejected for a ball or capsule: the search finds no direction there that the surface allows, so it
// would be deferred.
#include "geometry/manifold_mesh/mesh_reject.h"

#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::mesh_reject_test {
namespace {

using namespace test;

constexpr float kReach = 0.2f;

// `one_in`: of so many triangles before whose planes the shape lies, one at least must be known.
template <class MakeShape>
void check(MakeShape&& make, int one_in) {
  Random random{11};
  int left_out = 0, asked = 0;
  for (const bool double_sided : {false, true}) {
    const auto bumpy = [](float x, float z) { return 0.3f * std::sin(2.0f * x) * std::cos(3.0f * z); };
    const Geometry ground = grid(2.0f, 0.5f, bumpy).cook(double_sided);
    const Shape shape = make_shape(ground);
    const Surface surface(shape);
    for (int round = 0; round < 2000; ++round) {
      const AnyShape any = make(random);
      const Shape round_shape = make_shape(any);
      const Vec3 foot = random.in_box(1.8f);
      const Vec3 position{foot.x, bumpy(foot.x, foot.z) + round_shape.radius * random.between(0.7f, 1.5f),
                          foot.z};
      const LocalConvex convex(round_shape, random.rotation());
      for (std::uint32_t id = 0; id < surface.mesh->triangle_count(); ++id) {
        const LocalTriangle t = measured_triangle(surface, id, position, convex);
        const float height = dot(t.normal, t.v[0]), face = convex.lowest(t.normal) - height - convex.radius();
        if (dot(t.normal, convex.center()) < height || face > kReach) continue;
        ++asked;
        if (!is_round_rejected(surface, t, convex, face)) continue;
        ++left_out;
        AxisScratch scratch;
        const AxisSearch found = search_axes(surface, t, convex, face, kReach, scratch);
        ASSERT_GT(found.best, 0.0f);
        if (found.best > kReach) continue;
        ASSERT_LT(face, found.best - kAxisBias * convex.size());
        ASSERT_LT(found.feature.separation, found.best - kAxisBias * convex.size());
        bool outside = false;
        for (int i = 0; i < 3; ++i) outside = outside || convex.lies_outside(t.outward[i], t.v[i], t.slack);
        ASSERT_TRUE(outside) << "no point of the shape lies over it";
      }
    }
  }
  EXPECT_GT(left_out, asked / one_in);
}

TEST(MeshBeside, WhatABallLeavesOutHasNoAllowedDirection) {
  check([](Random& random) { return AnyShape(Sphere{random.between(0.05f, 0.5f)}); }, 4);
}

TEST(MeshBeside, WhatACapsuleLeavesOutHasNoAllowedDirection) {
  check(
      [](Random& random) {
        return AnyShape(Capsule{random.between(0.05f, 0.3f), random.between(0.05f, 0.5f)});
      },
      8);
}

}  // namespace
}  // namespace gyre::mesh_reject_test
