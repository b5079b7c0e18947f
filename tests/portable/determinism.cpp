// One small world with every kind of shape and joint, stepped for four seconds; prints the state's hash on the way.
// The same program is built for several processors and compilers, and all of them must print the same lines.
// Usage: determinism [threads] [simd width]
#include <gyre/gyre.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace {

using namespace gyre;

void add_floor(World& world) {
  BodyDef body;
  body.type = BodyType::fixed;
  ShapeDef shape;
  shape.geometry = Plane{};
  world.add_body(body, shape);
}

BodyId add(World& world, DVec3 place, const AnyShape& geometry, Vec3 spin = {}) {
  BodyDef body;
  body.pose.position = place;
  body.angular_velocity = spin;
  ShapeDef shape;
  shape.geometry = geometry;
  return world.add_body(body, shape);
}

void add_shapes(World& world) {
  const Vec3 corners[] = {{0, 0.6f, 0}, {0.5f, -0.3f, 0.1f}, {-0.4f, -0.3f, 0.4f}, {-0.3f, -0.2f, -0.5f}, {0.1f, 0.2f, 0.5f}};
  const Result<Geometry> hull = cook_hull(corners);
  if (!hull) {
    std::printf("no hull: %s\n", hull.error().message);
    std::exit(1);
  }
  const AnyShape shapes[] = {Sphere{0.4f},         Box{{0.5f, 0.3f, 0.4f}}, Capsule{0.25f, 0.4f},
                             Cylinder{0.3f, 0.4f}, Cone{0.4f, 0.4f},        AnyShape{*hull}};
  for (int layer = 0; layer < 4; ++layer) {
    for (int i = 0; i < 6; ++i) {
      // Slightly off the grid, so that they topple and roll over each other.
      const double x = 0.9 * (i % 3) + 0.07 * layer;
      const double z = 0.9 * (i / 3) - 0.05 * layer;
      add(world, {x, 0.8 + 1.1 * layer, z}, shapes[(i + layer) % 6], {0.3f * float(i), 0.1f, -0.2f * float(layer)});
    }
  }
}

void add_chain(World& world) {
  BodyId previous{};
  for (int i = 0; i < 6; ++i) {
    const BodyId link = add(world, {-3.0 + 0.5 * i, 4, 0}, Capsule{0.1f, 0.12f});
    JointDef joint;
    joint.kind = i % 2 == 0 ? JointKind::ball : JointKind::hinge;
    joint.a = previous;
    joint.b = link;
    joint.anchor = {-3.25 + 0.5 * i, 4, 0};
    joint.axis = {0, 0, 1};
    world.add_joint(joint);
    previous = link;
  }
}

}  // namespace

int main(int argc, char** argv) {
  WorldDef def;
  def.threads = argc > 1 ? std::atoi(argv[1]) : 1;
  def.simd_width = argc > 2 ? std::atoi(argv[2]) : 0;
  Result<World> made = World::create(def);
  if (!made) {
    std::printf("no world: %s\n", made.error().message);
    return 1;
  }
  World world = *std::move(made);
  add_floor(world);
  add_shapes(world);
  add_chain(world);
  for (int step = 1; step <= 240; ++step) {
    world.step(1.0f / 60.0f);
    if (step % 40 == 0) std::printf("%d %016" PRIx64 "\n", step, world.hash());
  }
  for (const Problem& problem : world.problems()) std::printf("problem: %s\n", problem.message);
  return world.problems().empty() ? 0 : 1;
}
