// Wheeled vehicles: a rigid body on wheels that are rays, with suspension, tyres, brakes, and an engine behind clutch, gearbox and
// differentials.
//
// Made of the public interface alone, like a user's own. A vehicle is plain data beside its body: VehicleDef says what it is,
// VehicleState how it is; copy the state with a snapshot of the world and both can be rolled back. Call drive_vehicle once before
// each World::step with the same seconds. SI units. docs/vehicles.md gives the equations and what was validated.
//
// Source: H. B. Pacejka, "Tire and Vehicle Dynamics", 3rd edition, 2012 (slip, similarity of combined slip, the bicycle model).
#pragma once

#include <gyre/world.h>

#include <vector>

namespace gyre::kit {

// Force over load against slip: `grip` at the peak, `slide` times that far beyond. With s = slip over the slip of the peak, along and
// across taken together as one vector, it is 2 s / (1 + s^2) of the peak up to it, along -s. So the cornering stiffness at small
// angles is 2 grip load / peak_angle.
struct TyreDef {
  float grip = 1.1f;
  float slide = 0.8f;
  float peak_slip = 0.12f;   // of (wheel speed - ground speed) / ground speed
  float peak_angle = 0.14f;  // rad
  float rolling = 0.012f;    // resistance over load
};

struct WheelDef {
  Vec3 mount{};             // m, body frame: where the wheel's middle is with the spring fully out
  float radius = 0.33f;     // m
  float inertia = 1.0f;     // kg m^2, of wheel and half shaft
  float travel = 0.25f;     // m, from fully out to the stop
  float stiffness = 30000;  // N/m
  float damping = 3000;     // N s/m
  float steer = 0.0f;       // share of the steering angle: 1 in front, below 0 the other way
  float brake = 2500;       // N m at full brake
  float handbrake = 0.0f;   // N m
  float drive =
      0.0f;  // share of the gearbox's torque; all wheels' shares sum to 1, or to 0 if nothing drives
  TyreDef tyre{};
};

// Two wheels on one axle.
struct AxleDef {
  int left = 0, right = 1;  // wheels
  float anti_roll = 0.0f;   // N for each m by which one spring is pressed in more than the other
  float lock = 0.0f;  // N m by which the differential resists a difference of speeds; 0: open, 1e9: locked
};

struct TorquePoint {
  float speed = 0.0f;   // rad/s
  float torque = 0.0f;  // N m at full throttle
};

struct EngineDef {
  std::vector<TorquePoint> curve{
      {80, 180}, {300, 260}, {500, 240}, {680, 160}};  // by speed; ends hold beyond
  float idle = 85;                                     // rad/s
  float redline = 680;                                 // rad/s: no fuel above it
  float inertia = 0.18f;                               // kg m^2
  float braking = 0.08f;                               // N m s/rad, without throttle
};

struct GearboxDef {
  std::vector<float> ratios{3.6f, 2.1f, 1.4f, 1.0f, 0.8f};
  float reverse = 3.4f;
  float final_ratio = 3.7f;
  float clutch = 500;        // N m that it holds
  float shift_time = 0.25f;  // s, with the clutch open
  bool automatic = true;     // shifts by itself between first and last gear
  float shift_up = 580;      // rad/s of the engine
  float shift_down = 240;
};

// Wheels that a track binds to one speed.
struct TrackDef {
  std::vector<int> wheels{};
  float side = 1.0f;       // 1 on the left, -1 on the right
  float steering = 20000;  // N m, which full lock adds on one side and takes on the other
};

// Keeps a two-wheeler from falling: leans it into bends until gravity and the bend's acceleration balance, like a rider. A torque
// about its length from nowhere; in a steady bend next to none is left, as the wheels' forces pass through the centre of mass.
struct LeanDef {
  float frequency = 0.0f;  // Hz, of the lean; 0: none. Above 1.5 for something as tall as a motorcycle
  float damping_ratio = 1.0f;
  float most = 0.85f;  // rad; steering is held back so that no more is needed
};

struct VehicleDef {
  Vec3 forward{0, 0, 1};  // body frame, length 1
  Vec3 up{0, 1, 0};
  std::vector<WheelDef> wheels{};  // 1 to 16
  std::vector<AxleDef> axles{};
  std::vector<TrackDef> tracks{};
  LeanDef lean{};
  EngineDef engine{};
  GearboxDef gearbox{};
  float steer_angle = 0.6f;            // rad at full lock
  std::uint32_t layers = 0xffffffffu;  // shapes that wheels roll on
};

struct WheelState {
  float spin = 0.0f;         // rad/s
  float angle = 0.0f;        // rad, by which it has turned
  float steer = 0.0f;        // rad, to the left
  float compression = 0.0f;  // m
  float load = 0.0f;         // N
  float slip = 0.0f, slip_angle = 0.0f;
  Vec3 force{};  // N on the vehicle, of the tyre, world frame
  bool on_ground = false;
  DVec3 contact{};
  Vec3 normal{};
  BodyId ground{};
};

struct VehicleState {
  static constexpr int kMaxWheels = 16;
  WheelState wheels[kMaxWheels]{};
  float engine_speed = 85;   // rad/s
  int gear = 1;              // -1 reverse, 0 neutral, 1 first ...
  float shifting = 0.0f;     // s that are left of a shift
  float lean_torque = 0.0f;  // N m, in the last call
};

struct VehicleInput {
  float throttle = 0.0f;   // 0 to 1
  float brake = 0.0f;      // 0 to 1
  float handbrake = 0.0f;  // 0 to 1
  float steer = 0.0f;      // -1 (right) to 1 (left)
  int gear = 1;            // asked for: -1, 0 or 1 and above; an automatic gearbox takes above 0 as forward
  float clutch = 0.0f;     // 0 closed, 1 open
};

// Why a definition cannot be used; code none if it can.
Error check_vehicle(const VehicleDef& def);

// Gives the body the forces of its wheels for the next step, and turns wheels and engine on by `seconds`. What wheels roll on is
// pushed back if it is dynamic. An error if something cannot be used; nothing changes then.
Error drive_vehicle(World& world, const VehicleDef& def, BodyId body, VehicleState& state,
                    const VehicleInput& input, float seconds);

// Where a wheel's middle is, and how it is turned: about its axle (to the left) by `angle`, after steering.
Pose wheel_pose(const World& world, const VehicleDef& def, BodyId body, const VehicleState& state, int wheel);

}  // namespace gyre::kit
