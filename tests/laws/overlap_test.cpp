// What was put into each other parts: by places, and by no more speed than springs may give.
#include "laws/kit.h"

namespace gyre::laws::overlap_test {
namespace {

// The fastest that any of the bodies ever was, over a second; and how they lie then.
struct Parted {
  double fastest = 0.0, gap = 0.0, middle = 0.0;
};
Parted part(const AnyShape& shape, double apart, float density_b) {
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  const BodyId a = world.add_body({}, {.geometry = shape});
  const BodyId b = world.add_body({.pose = {.position = {apart, 0, 0}}}, {.geometry = shape, .density = density_b});
  const auto middle = [&] {
    const double ma = double(world.mass_properties(a).mass), mb = double(world.mass_properties(b).mass);
    return (ma * world.pose(a).position.x + mb * world.pose(b).position.x) / (ma + mb);
  };
  const double before = middle();
  Parted parted;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    for (const BodyId body : {a, b}) {
      parted.fastest = std::max(parted.fastest, double(length(world.linear_velocity(body))));
    }
  }
  parted.gap = world.pose(b).position.x - world.pose(a).position.x - 1.0;
  parted.middle = middle() - before;
  return parted;
}

TEST(Overlap, IsTakenBackWithLittleSpeed) {
  for (const AnyShape& shape : {AnyShape(Box{}), AnyShape(Sphere{})}) {
    for (const float density : {1000.0f, 100.0f}) {
      const Parted parted = part(shape, 0.8, density);
      EXPECT_TRUE(limit_row("overlap of 0.2 m after 1 s (m)", -parted.gap, 1e-3, 3e-4));
      // An eighth of 0.4 sqrt(g size), of which a light body has its share; size: half of the box, the radius of the ball.
      EXPECT_TRUE(limit_row("speed while it parts (m/s)", parted.fastest, 0.125 * 0.4 * std::sqrt(kGravity * 0.5), 1e-3));
      EXPECT_TRUE(limit_row("move of the common centre (m)", std::fabs(parted.middle), 1e-5, 1e-6));
    }
  }
}

}  // namespace
}  // namespace gyre::laws::overlap_test
