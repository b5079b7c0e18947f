// Solids of any stiffness at rest.
#include "laws/kit.h"

namespace gyre::laws::soft_robustness_test {
namespace {

// A block rests with its weight whatever its stiffness.
TEST(SoftRobustness, BlocksOfAnyStiffnessRest) {
  for (const float modulus : {1.0e3f, 1.0e5f, 1.0e7f, 1.0e10f}) {
    World world = make_world({.sleeping = false});
    add_ground(world);
    const SoftId block = world.add_solid({.box = SolidBox{{0.1f, 0.1f, 0.1f}, {2, 2, 2}},
                                          .pose = {{0, 0.101, 0}, {}},
                                          .density = 100.0f,
                                          .young_modulus = modulus,
                                          .settings = {.damping = 0.01f}});
    run(world, 3.0);
    double height = 0.0, speed = 0.0;
    const SoftVertices v = world.vertices(block);
    for (std::size_t i = 0; i < v.size(); ++i) {
      height += v.y[i] / double(v.size());
      speed = std::fmax(speed, length(wide(v.velocity(i))));
    }
    // Its middle sinks by rho g L^2 / (8 E) about, at most by the whole extension of its weight.
    const double sink = 100.0 * kGravity * 0.04 / (2.0 * double(modulus));
    EXPECT_TRUE(limit_row("S-23 block of 1 kPa to 10 GPa at rest: m/s", speed, 1e-2, 1e-3));
    EXPECT_NEAR(height, 0.1 - 0.5 * sink, 0.5 * sink + 0.002) << modulus;
  }
}

}  // namespace
}  // namespace gyre::laws::soft_robustness_test
