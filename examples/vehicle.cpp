// A car accelerates, brakes and turns.
#include <gyre/gyre.h>
#include <gyre/kit/vehicle.h>

#include <cstdio>

using namespace gyre;

int main() {
  World world = *World::create({});
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  // The centre of mass is low, as in a car; the box is the shell alone.
  BodyDef shell{.pose = {{0, 0.6, 0}, {}}};
  shell.mass = 1400.0f;
  shell.center_of_mass = Vec3{0, -0.1f, 0.05f};
  const BodyId body =
      world.add_body(shell, {.geometry = Box{{0.85f, 0.25f, 2.1f}}, .local = {{0, 0.25f, 0}, {}}});

  kit::VehicleDef car;
  for (const float front : {1.0f, 0.0f}) {
    for (const float side : {0.75f, -0.75f}) {  // left, right
      kit::WheelDef wheel;
      wheel.mount = {side, -0.2f, front > 0 ? 1.3f : -1.3f};
      wheel.steer = front;
      wheel.drive = 0.5f * (1.0f - front);
      car.wheels.push_back(wheel);
    }
  }
  car.axles = {{.left = 0, .right = 1, .anti_roll = 8000}, {.left = 2, .right = 3, .anti_roll = 6000}};

  kit::VehicleState state;
  const float step = 1.0f / 60.0f;
  for (int i = 0; i < 900; ++i) {
    kit::VehicleInput input;
    if (i > 60 && i < 500) input.throttle = 1.0f;
    if (i >= 500 && i < 600) input.steer = 0.06f;
    if (i >= 700) input.brake = 0.8f;
    if (const Error e = kit::drive_vehicle(world, car, body, state, input, step); e.code != ErrorCode::none) {
      std::printf("%s\n", e.message);
      return 1;
    }
    world.step(step);
    if (i % 100 != 99) continue;
    const DVec3 p = world.pose(body).position;
    std::printf("%4.1f s  %5.1f km/h  gear %d  %4.0f rpm  at (%.1f, %.1f)\n", world.time(),
                double(3.6f * length(world.linear_velocity(body))), state.gear,
                double(state.engine_speed * 9.549f), p.x, p.z);
  }
  return length(world.linear_velocity(body)) < 1.0f ? 0 : 1;
}
