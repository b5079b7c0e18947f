// Positions are double; vectors between two bodies are float. So a stack stands and a ball bounces a hundred thousand kilometres
// from the origin as they do at the origin.
#include <gyre/gyre.h>

#include <cmath>
#include <cstdio>

using namespace gyre;

namespace {

struct Outcome {
  double stack = 0;  // height of the top box above its floor
  double ball = 0;   // greatest height of the ball after its first bounce
};

Outcome run(DVec3 at) {
  World world = *World::create({.sleeping = false});
  world.add_body({.type = BodyType::fixed, .pose = {.position = at + DVec3{0, -1, 0}}},
                 {.geometry = Box{{20, 1, 20}}});
  BodyId top;
  for (int i = 0; i < 8; ++i) {
    top = world.add_body({.pose = {.position = at + DVec3{0, 0.5 + i, 0}}}, {.geometry = Box{}});
  }
  const BodyId ball = world.add_body({.pose = {.position = at + DVec3{5, 2.25, 0}}},
                                     {.geometry = Sphere{0.25f}, .material = {.restitution = 0.8f}});
  Outcome outcome;
  bool bounced = false;
  for (int i = 0; i < 90; ++i) {
    world.step(1.0f / 60.0f);
    bounced = bounced || world.linear_velocity(ball).y > 1;
    const double height = world.pose(ball).position.y - at.y - 0.25;
    if (bounced && height > outcome.ball) outcome.ball = height;
  }
  outcome.stack = world.pose(top).position.y - at.y;

  // Renderers use floats: a pose relative to the camera keeps its precision.
  const Mat4 model = model_matrix(world.pose(top), at);
  std::printf("seen from near by, the top box is at height %.4f m\n", double(model.elements[13]));
  return outcome;
}

}  // namespace

int main() {
  const Outcome near = run({0, 0, 0});
  const Outcome far = run({1e8, 2e7, -1e8});
  std::printf("origin: stack %.4f m, bounce %.4f m (exactly %.4f)\n", near.stack, near.ball, 2 * 0.8 * 0.8);
  std::printf("far:    stack %.4f m, bounce %.4f m\n", far.stack, far.ball);
  return std::fabs(near.stack - far.stack) < 1e-3 && std::fabs(near.ball - far.ball) < 1e-2 ? 0 : 1;
}
