// Debugging: explains why a box is awake, prints the time of each stage, and makes debug lines.
#include <gyre/debug.h>
#include <gyre/gyre.h>

#include <cstdio>

int main() {
  gyre::Result<gyre::World> world = gyre::World::create();
  if (!world) return 1;
  gyre::set_timing(*world, true);
  world->add_body({.type = gyre::BodyType::fixed}, {.geometry = gyre::Plane{}});
  const gyre::BodyId box = world->add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = gyre::Box{}});
  const gyre::BodyId ball =
      world->add_body({.pose = {.position = {0.1, 3, 0}}}, {.geometry = gyre::Sphere{}});
  for (int step = 0; step < 60; ++step) world->step(1.0f / 60.0f);

  for (const gyre::BodyId body : {box, ball}) std::printf("%s\n", gyre::explain(*world, body).words);

  gyre::StepTimes times;
  gyre::read_times(*world, times);
  for (const gyre::StageSeconds& stage : times.stages)
    std::printf("%-18s %4.0f %%\n", stage.name, 100.0 * stage.seconds / times.seconds);

  // One call fills the arrays that a renderer uploads.
  gyre::DebugDraw drawing;
  gyre::draw_debug(*world, {.origin = world->center_of_mass(box), .color_by = gyre::ColorBy::rest_state},
                   drawing);
  std::printf("%zu lines, %zu points\n", drawing.line_count(), drawing.point_count());

  const gyre::Error fault = gyre::validate(*world);
  std::printf("%s\n", fault.code == gyre::ErrorCode::none ? "all structures agree" : fault.message);
  return fault.code == gyre::ErrorCode::none ? 0 : 1;
}
