// The submerged part of a shape against counted points and an independent adaptive integral, and its invariants: the
// whole volume is known, the cut is the rate of the volume, and both sides of a plane make the whole.
#include "geometry/mass/submerged.h"

#include "geometry/shape/hull.h"
#include "geometry/shape/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gyre::submerged_test {
namespace {

struct Named {
  const char* name;
  AnyShape shape;
};

Geometry hull_of(std::vector<Vec3> points) {
  Result<Geometry> made = cook_hull(points);
  EXPECT_TRUE(bool(made)) << made.error().message;
  return *made;
}

std::vector<Named> shapes() {
  return {{"sphere", Sphere{0.7f}},
          {"box", Box{{0.5f, 0.3f, 0.8f}}},
          {"capsule", Capsule{0.3f, 0.6f}},
          {"cylinder", Cylinder{0.5f, 0.25f}},
          {"cone", Cone{0.4f, 0.6f}},
          {"wedge", hull_of({{0, 1, 0}, {1, 0, 0}, {-1, 0, 1}, {-1, 0, -1}})},
          {"gem", hull_of({{0.9f, 0, 0},
                           {-0.8f, 0.1f, 0},
                           {0, 0.7f, 0.1f},
                           {0.1f, -0.6f, 0},
                           {0, 0.2f, 1.1f},
                           {0.1f, 0, -0.9f},
                           {0.5f, 0.4f, 0.3f},
                           {-0.4f, -0.3f, 0.5f}})}};
}

// Numbers in [0, 1) that repeat.
class Dice {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return double(state_ >> 11) * 0x1p-53;
  }
  DVec3 direction() {
    while (true) {
      const DVec3 v{2 * next() - 1, 2 * next() - 1, 2 * next() - 1};
      const double size = length(v);
      if (size > 0.1 && size < 1) return v / size;
    }
  }

 private:
  std::uint64_t state_ = 12345;
};

bool contains(const Shape& s, DVec3 p) {
  const double r = double(s.radius), h = double(s.extents.y), rho = std::hypot(p.x, p.z);
  switch (s.kind) {
    case ShapeKind::sphere:
      return length(p) < r;
    case ShapeKind::box:
      return std::fabs(p.x) < double(s.extents.x) && std::fabs(p.y) < h &&
             std::fabs(p.z) < double(s.extents.z);
    case ShapeKind::capsule:
      return std::hypot(rho, p.y - std::fmax(-h, std::fmin(h, p.y))) < r;
    case ShapeKind::cylinder:
      return rho < r && std::fabs(p.y) < h;
    case ShapeKind::cone:
      return std::fabs(p.y) < h && rho < r * (h - p.y) / (2 * h);
    default:
      for (const HullPlane& plane : s.hull->planes)
        if (dot(DVec3(plane.normal), p) > double(plane.offset)) return false;
      return true;
  }
}

double extent(const Shape& shape, DVec3 normal) {
  return double(dot(support(shape, to_float(normal)), to_float(normal))) +
         (shape.kind == ShapeKind::box ? 0.0 : double(core_radius(shape)));
}

// Points of a regular grid, counted. The error of a count of n cells across is a few 1/n of the surface's share.
TEST(Submerged, EqualsCountedPoints) {
  constexpr int kCells = 120;
  Dice dice;
  for (const Named& named : shapes()) {
    const Shape shape = make_shape(named.shape);
    const Aabb box = bounds(shape, {});
    const DVec3 low(box.low), size = DVec3(box.high) - DVec3(box.low);
    const double cell = size.x * size.y * size.z / double(kCells * kCells * kCells);
    for (int trial = 0; trial < 4; ++trial) {
      const DVec3 n = dice.direction();
      const double top = extent(shape, n), bottom = -extent(shape, -n);
      const double level = bottom + (0.15 + 0.7 * dice.next()) * (top - bottom);
      double volume = 0;
      DVec3 first;
      for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
          for (int k = 0; k < kCells; ++k) {
            const DVec3 p{low.x + size.x * (i + 0.5) / kCells, low.y + size.y * (j + 0.5) / kCells,
                          low.z + size.z * (k + 0.5) / kCells};
            if (dot(n, p) >= level || !contains(shape, p)) continue;
            volume += cell;
            first += cell * p;
          }
        }
      }
      const SubmergedPart part = submerged_part(shape, n, level);
      const double whole = volume_of(shape);
      EXPECT_NEAR(part.volume, volume, 2.0e-3 * whole) << named.name;
      EXPECT_NEAR(length(part.center - first / volume), 0.0, 3.0e-3 * (top - bottom)) << named.name;
    }
  }
}

// The parts below and above a plane make the whole. Far planes cut off nothing or everything.
TEST(Submerged, TwoSidesMakeTheWhole) {
  Dice dice;
  for (const Named& named : shapes()) {
    const Shape shape = make_shape(named.shape);
    const Result<MassProperties> mass = mass_properties(named.shape, 1.0f);
    ASSERT_TRUE(bool(mass));
    const double whole = volume_of(shape);
    EXPECT_NEAR(whole, double(mass->mass), 1.0e-6 * whole) << named.name;
    for (int trial = 0; trial < 200; ++trial) {
      const DVec3 n = trial == 0 ? DVec3{0, 1, 0} : trial == 1 ? DVec3{1, 0, 0} : dice.direction();
      const double top = extent(shape, n), bottom = -extent(shape, -n);
      const double level = bottom + dice.next() * (top - bottom);
      const SubmergedPart below = submerged_part(shape, n, level), above = submerged_part(shape, -n, -level);
      EXPECT_NEAR(below.volume + above.volume, whole, 1.0e-8 * whole) << named.name << " " << trial;
      const DVec3 middle = (below.volume * below.center + above.volume * above.center) / whole;
      EXPECT_NEAR(length(middle - DVec3(mass->center)), 0.0, 1.0e-6) << named.name << " " << trial;
      EXPECT_NEAR(below.area, above.area, 1.0e-7 * (below.area + 1.0e-3)) << named.name;
      EXPECT_EQ(submerged_part(shape, n, bottom - 0.01).volume, 0.0) << named.name;
      EXPECT_NEAR(submerged_part(shape, n, top + 0.01).volume, whole, 1.0e-12 * whole + 1e-15) << named.name;
    }
  }
}

// The area of the cut is the rate of the volume with the level. Its first and second moments are the rates of volume
// times centre when the level rises and when the plane tips.
TEST(Submerged, TheCutIsTheRateOfTheVolume) {
  Dice dice;
  constexpr double kSmall = 1.0e-4;
  for (const Named& named : shapes()) {
    const Shape shape = make_shape(named.shape);
    for (int trial = 0; trial < 50; ++trial) {
      const DVec3 n = dice.direction();
      const double top = extent(shape, n), bottom = -extent(shape, -n);
      const double level = bottom + (0.1 + 0.8 * dice.next()) * (top - bottom);
      const SubmergedPart part = submerged_part(shape, n, level);
      const SubmergedPart more = submerged_part(shape, n, level + kSmall),
                          less = submerged_part(shape, n, level - kSmall);
      const double size = std::pow(volume_of(shape), 1.0 / 3.0);
      // Corners and edges give the area kinks: a central difference is then of first order.
      const double slack = 20.0 * kSmall * size;
      EXPECT_NEAR((more.volume - less.volume) / (2 * kSmall), part.area, slack) << named.name;
      const DVec3 first = (more.volume * more.center - less.volume * less.center) / (2 * kSmall);
      EXPECT_NEAR(length(first - part.area * part.area_center), 0.0, slack * size) << named.name;
      // Tipping about an axis in the plane through the cut's centre: d(V center)/d(angle) along u is the spread along u.
      const DVec3 u = cross(n, DVec3{0.3, 0.5, 0.8}) / length(cross(n, DVec3{0.3, 0.5, 0.8}));
      const auto tipped = [&](double angle) {
        const DVec3 m = std::cos(angle) * n - std::sin(angle) * u;
        return submerged_part(shape, m, dot(m, part.area_center));
      };
      const SubmergedPart left = tipped(kSmall), right = tipped(-kSmall);
      const DVec3 rate = (left.volume * left.center - right.volume * right.center) / (2 * kSmall);
      const SecondMoments& s = part.spread;
      const DVec3 su{s.xx * u.x + s.xy * u.y + s.xz * u.z, s.xy * u.x + s.yy * u.y + s.yz * u.z,
                     s.xz * u.x + s.yz * u.y + s.zz * u.z};
      EXPECT_NEAR(dot(rate, u), dot(su, u), slack * size * size) << named.name;
      EXPECT_NEAR((left.volume - right.volume) / (2 * kSmall), 0.0, slack * size) << named.name;
    }
  }
}

// Slices summed in closed form against the same integral by brute force, at all angles: what the header promises.
TEST(Submerged, RoundShapesAreWithinTheStatedError) {
  Dice dice;
  double worst = 0;
  for (const AnyShape& any :
       {AnyShape(Capsule{0.3f, 0.6f}), AnyShape(Cylinder{0.5f, 0.25f}), AnyShape(Cone{0.4f, 0.6f})}) {
    const Shape shape = make_shape(any);
    const double r = double(shape.radius), h = double(shape.extents.y);
    const double end = h + (shape.kind == ShapeKind::capsule ? r : 0.0);
    for (int trial = 0; trial < 12; ++trial) {
      const DVec3 n = dice.direction();
      const double lean = std::hypot(n.x, n.z);
      const double level = (dice.next() - 0.5) * r;
      constexpr int kSlices = 400000;
      double volume = 0;
      for (int i = 0; i < kSlices; ++i) {
        const double y = -end + 2 * end * (i + 0.5) / kSlices;
        const double z = std::fmax(std::fabs(y) - h, 0.0);
        const double rho = shape.kind == ShapeKind::cone ? r * (h - y) / (2 * h) : std::sqrt(r * r - z * z);
        const double t = (level - n.y * y) / lean;
        if (t >= rho)
          volume += kPiDouble * rho * rho;
        else if (t > -rho)
          volume += rho * rho * (kPiDouble - std::acos(t / rho)) + t * std::sqrt(rho * rho - t * t);
      }
      volume *= 2 * end / kSlices;
      const double error = std::fabs(submerged_part(shape, n, level).volume - volume) / volume_of(shape);
      worst = std::fmax(worst, error);
    }
  }
  std::printf("[row] submerged volume of round shapes, worst error %.2e of the whole\n", worst);
  EXPECT_LT(worst, 1.0e-8);  // the sum by brute force is itself good to a few 1e-9: slices end in roots
}

}  // namespace
}  // namespace gyre::submerged_test
