// GJK proves its answers: every two convex kinds, with needles, plates, sizes ten thousandfold apart, pairs that touch and
// pairs that coincide.
//
// Points that lie in the two cores are an upper bound of their distance, and how far the cores are apart along the normal is
// a lower one, both worked out here from what a box, a cone and so on are. Where the bounds meet the answer is right,
// whatever way led to it. A point that lies in both cores proves that they overlap.
#include "geometry/distance/gjk.h"

#include "geometry/testing/degenerate_pairs.h"

#include <gtest/gtest.h>

namespace gyre::gjk_proof_test {
namespace {

using namespace oracle;

// The exact distance of a point (in the shape's frame) outside a core; 0 or negative inside.
double outside(const Shape& shape, DVec3 p) {
  const DVec3 e(shape.extents);
  const double r = double(shape.radius), h = e.y;
  const double radial = std::sqrt(p.x * p.x + p.z * p.z);
  switch (shape.kind) {
    case ShapeKind::box:
      return max(max(absolute(p.x) - e.x, absolute(p.y) - e.y), absolute(p.z) - e.z);
    case ShapeKind::capsule:
      return max(radial, absolute(p.y) - h);
    case ShapeKind::cylinder:
      return max(radial - r, absolute(p.y) - h);
    case ShapeKind::cone:
      return max(-h - p.y, (2.0 * h * radial - r * (h - p.y)) / std::sqrt(4.0 * h * h + r * r));
    case ShapeKind::hull: {
      double worst = -1.0e300;
      for (const HullPlane& plane : shape.hull->planes)
        worst = max(worst, dot(DVec3(plane.normal), p) - double(plane.offset));
      return worst;
    }
    default:
      return length(p);
  }
}

testing::AssertionResult proven(const Shape& a, const Shape& b, const CorePair& pair,
                                const CoreDistance& found, Random& random) {
  const double size = pair.size();
  const auto no = [&](const char* what, double by) {
    return testing::AssertionFailure()
           << what << " by " << by / size << " of the size after " << found.iterations << " rounds";
  };
  const DVec3 in_b = pair.to_b(found.on_b - pair.center_of_b());
  const double gap = length(found.on_b - found.on_a);
  // Faces of hulls are planes in float.
  const double out_a = outside(a, found.on_a) - (a.kind == ShapeKind::hull ? 2.0e-6 : 1.0e-9) * size;
  const double out_b = outside(b, in_b) - (b.kind == ShapeKind::hull ? 2.0e-6 : 1.0e-9) * size;
  if (found.overlap) {
    if (out_a <= 0.0 && out_b <= 0.0 && gap <= 1.0e-9 * size) return testing::AssertionSuccess();
    // The weights of a sliver may be poor. Then no direction may separate the cores.
    const double apart = sampled_separation(a, b, pair, random, 200);
    if (apart > 2.0e-10 * size) return no("overlap that is none,", apart);
    return testing::AssertionSuccess();
  }
  if (out_a > 0.0) return no("point of A outside", out_a);
  if (out_b > 0.0) return no("point of B outside", out_b);
  if (absolute(length(found.normal) - 1.0) > 1.0e-9) return no("normal too long", length(found.normal) - 1.0);
  if (absolute(gap - found.distance) > 1.0e-8 * size) return no("points elsewhere", gap - found.distance);
  const double proof = separation(a, b, pair, found.normal);
  // At a hundred-thousandth of the size, the closest points of a rim may be slightly beside the best.
  const double good = gap > 1.0e-5 * size ? 1.0e-6 : 5.0e-6;
  // A difference of points of this size is good to 1e-16 of it, and its direction to that over the distance.
  const double direction = gap > 0.0 ? 1.0e-15 * size / gap : 0.0;
  if (gap - proof > (good + direction) * size) return no("bounds do not meet,", gap - proof);
  return testing::AssertionSuccess();
}

void expect_proofs(int pairs, unsigned seed) {
  Random random(seed);
  int overlaps = 0, failures = 0;
  for (int begin = 0; begin < pairs && failures < 10; begin += 2000) {
    Hulls hulls;
    for (int i = begin; i < min(pairs, begin + 2000); ++i) {
      const DegeneratePair odd = degenerate_pair(random, hulls, i / kKinds % kKinds, i % kKinds);
      const CorePair pair(odd.a, odd.b, odd.t);
      const Vec3 guess = random.below(3) == 0 ? random.direction() : Vec3{};
      const CoreDistance found = core_distance(pair, 1.0e30, guess);
      const auto result = proven(odd.a, odd.b, pair, found, random);
      EXPECT_TRUE(result) << kind_name(i / kKinds % kKinds) << " and " << kind_name(i % kKinds) << ", pair "
                          << i;
      if (!result) ++failures;
      if (found.overlap) ++overlaps;
    }
  }
  EXPECT_GT(overlaps, pairs / 4);
  EXPECT_LT(overlaps, 3 * pairs / 4);
}

TEST(GjkProof, OfTenThousandOddPairs) { expect_proofs(10000, 31); }
TEST(LongGjkProof, OfAMillionOddPairs) { expect_proofs(1000000, 32); }

// Two cylinders at half a metre counted as overlapping: of the points of a rim, three and a far one made a tetrahedron so
// thin that rounding put the origin inside.
TEST(Gjk, CylindersApartDoNotOverlap) {
  const Shape a = make_along_y(ShapeKind::cylinder, 0.20494242f, 0.899228513f);
  const Shape b = make_along_y(ShapeKind::cylinder, 0.498842657f, 0.76639235f);
  const Transform t{{-0.424761981f, 0.67716229f, 0.600371361f},
                    {0.177807912f, 0.872044206f, -0.0447862446f, 0.453781068f}};
  EXPECT_FALSE(core_distance(CorePair(a, b, t), 10.0, {}).overlap);
}
TEST(Gjk, ACylinderApartFromABoxDoesNotOverlapIt) {
  const Shape a = make_along_y(ShapeKind::cylinder, 0.501172841f, 0.172975764f);
  const Shape b = make_box({0.512765586f, 0.184247807f, 0.0962375477f});
  const Transform t{{0.610159338f, -0.372354805f, 0.333024979f},
                    {-0.113356002f, -0.55930531f, 0.579607666f, 0.581707001f}};
  EXPECT_FALSE(core_distance(CorePair(a, b, t), 10.0, {}).overlap);
}

// A normal that pointed the other way: the foot on a sliver of three nearly equal rim points.
TEST(Gjk, NearACylinderTheNormalKeepsItsSide) {
  Random random(33);
  for (int i = 0; i < 20000; ++i) {
    const float radius = random(0.2f, 1.0f);
    const float half = random(0.2f, 1.0f);
    const Shape cone =
        make_along_y(random.below(2) == 0 ? ShapeKind::cone : ShapeKind::cylinder, radius, half);
    const Shape ball = make_sphere(0.1f);
    Transform t{3.0f * random.direction(), {}};
    const CoreDistance far = core_distance(CorePair(cone, ball, t), 1.0e30, {});
    t.position = t.position - to_float((far.distance - 1.0e-7) * far.normal);
    const CorePair pair(cone, ball, t);
    const CoreDistance near = core_distance(pair, 1.0e30, {});
    if (near.overlap) continue;
    ASSERT_GT(separation(cone, ball, pair, near.normal), -1.0e-6) << i;
  }
}

}  // namespace
}  // namespace gyre::gjk_proof_test
