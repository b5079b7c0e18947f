// A scene with every kind of joint at work, See scenes.h, which includes this.
#pragma once

#include <gyre/gyre.h>

namespace gyre::scenes {

struct KindMaker {
  World& world;

  BodyId body(double x, double y) {
    BodyDef def;
    def.pose.position = {x, y, 0};
    def.angular_velocity = {0.25f, -0.5f, 0.125f};
    ShapeDef shape;
    shape.geometry = Box{{0.25f, 0.125f, 0.375f}};
    return world.add_body(def, shape);
  }
};

inline void build_joint_kinds(World& world) {
  KindMaker make{world};
  BodyId last = make.body(0, 6);
  for (int i = 1; i < 6; ++i) {  // a limb of cones
    const BodyId next = make.body(0.75 * i, 6);
    ConeDef cone{.a = last, .b = next, .anchor = {0.75 * i - 0.375, 6, 0}};
    cone.limits = Limits{-0.25f, 0.5f};
    cone.swing_y = 0.5f, cone.swing_z = 0.25f;
    cone.friction = 2.0f;
    cone.drive.frequency = 2.0f, cone.drive.max_torque = 4.0f;
    world.add_joint(cone);
    last = next;
  }
  const BodyId shaft = make.body(6, 6), other = make.body(7, 6);
  UniversalDef universal{.a = shaft, .b = other, .anchor = {6.5, 6, 0}};
  universal.axis_b = Vec3{0, 0.25f, 1};
  universal.angular_z.stiffness = 8.0f, universal.angular_z.damping = 0.5f;
  world.add_joint(universal);
  SixDofDef six{.b = shaft, .anchor = {6, 6, 0}};
  six.linear_y.motion = AxisMotion::limited, six.linear_y.limits = {-0.25f, 0.25f}, six.linear_y.limit_frequency = 3.0f;
  six.angular_x.motion = AxisMotion::free, six.angular_x.motor = {.target_velocity = 2.0f, .max_force = 50.0f};
  six.angular_z.motion = AxisMotion::free, six.angular_z.friction = 4.0f;
  world.add_joint(six);
  const BodyId first = make.body(9, 6), second = make.body(10, 6), rack = make.body(10, 5);
  HingeDef bearing{.b = first, .anchor = {9, 6, 0}};
  bearing.axis = {0, 0, 1}, bearing.motor = {.target_velocity = 5.0f, .max_force = 40.0f}, bearing.friction = 1.0f;
  bearing.stiffness = 2.0f;
  world.add_joint(bearing);
  bearing = HingeDef{.b = second, .anchor = {10, 6, 0}};
  bearing.axis = {0, 0, 1};
  world.add_joint(bearing);
  world.add_joint(SliderDef{.b = rack, .anchor = {10, 5, 0}});
  GearDef gear{.a = first, .b = second, .anchor = {9, 6, 0}};
  gear.axis = {0, 0, 1}, gear.ratio = 2.5f;
  world.add_joint(gear);
  RackAndPinionDef teeth{.a = second, .b = rack, .anchor = {10, 6, 0}};
  teeth.axis = {0, 0, 1}, teeth.axis_b = Vec3{1, 0, 0}, teeth.ratio = 1.0f;
  world.add_joint(teeth);
  const BodyId has_extreme_mass_ratio = make.body(13, 6), heavy = make.body(14, 6), tyre = make.body(13, 5);
  PulleyDef rope{.a = has_extreme_mass_ratio, .b = heavy, .anchor = {13, 6, 0}};
  rope.ratio = 1.5f, rope.ground_a = {13, 9, 0}, rope.ground_b = {14, 8, 0.5};
  world.add_joint(rope);
  WheelDef wheel{.a = has_extreme_mass_ratio, .b = tyre, .anchor = {13, 5, 0}};
  wheel.axis = {0, 1, 0}, wheel.axis_b = Vec3{0, 0, 1}, wheel.limits = Limits{-0.25f, 0.25f};
  wheel.stiffness = 4000.0f, wheel.damping = 200.0f, wheel.motor = {.target_velocity = 3.0f, .max_force = 10.0f};
  wheel.steering.motion = AxisMotion::limited, wheel.steering.limits = {-0.5f, 0.5f};
  world.add_joint(wheel);
  PathDef track{.b = make.body(17, 6), .anchor = {17, 6, 0}};
  track.points = {{-1, 1, 0}, {0, 0, 0}, {1, 1, 0.5f}, {0, 2, 0}};
  track.closed = true, track.orientation = PathOrientation::following;
  world.add_joint(track);
  track = PathDef{.b = make.body(20, 6), .anchor = {20, 6, 0}};
  track.points = {{-1, 1, 0}, {0, 0, 0}, {1, 1, 0.5f}};
  world.add_joint(track);
  MouseDef mouse{.b = make.body(23, 6), .anchor = {23.25, 6, 0}};
  mouse.drive.position = {0.5f, 1, 0}, mouse.drive.frequency = 2.0f, mouse.drive.max_force = 4000.0f;
  world.add_joint(mouse);
  MotorDef motor{.a = heavy, .b = make.body(26, 6), .anchor = {26, 6, 0}};
  motor.drive.orientation = {0, 0, 0.6f, 0.8f}, motor.drive.max_force = 500.0f, motor.drive.max_torque = 50.0f;
  world.add_joint(motor);
}

}  // namespace gyre::scenes
