// Wheeled vehicles: a rigid body on ray-cast wheels with suspension, tyres and brakes, and an engine with clutch, gearbox and differentials.
//
// It uses the public headers only. A vehicle is plain data beside its body: VehicleDef describes it, VehicleState has its state. Copy the
// state together with a snapshot of the world, and both can be rolled back. Call drive_vehicle once before each World::step with the same
// seconds. SI units. docs/vehicles.md has the equations and the validation.
//
// Source: H. B. Pacejka, "Tire and Vehicle Dynamics", 3rd edition, 2012 (slip, similarity of combined slip, the bicycle model).
#pragma once

#include <gyre/world.h>

#include <vector>

namespace gyre::kit {

// Tyre force against slip. The force is `grip` times the load at the peak and falls to `slide` times that far beyond it. Let s be the slip
// vector (longitudinal and lateral together) relative to the slip of the peak: up to the peak the force is 2 s / (1 + s^2) of the peak
// force, along -s. So the cornering stiffness at small angles is 2 grip load / peak_angle.
struct TyreDef {
  float grip = 1.1f;
  float slide = 0.8f;
  float peak_slip = 0.12f;   // longitudinal: (wheel speed - ground speed) / ground speed
  float peak_angle = 0.14f;  // rad
  float rolling = 0.012f;    // rolling resistance over load
};

struct WheelDef {
  Vec3 mount{};             // m, body frame: the wheel's centre with the spring fully extended
  float radius = 0.33f;     // m
  float inertia = 1.0f;     // kg m^2, of wheel and half shaft
  float travel = 0.25f;     // m, from fully extended to the bump stop
  float stiffness = 30000;  // N/m
  float damping = 3000;     // N s/m
  float steer = 0.0f;       // share of the steering angle: 1 in front, below 0 in the opposite direction
  float brake = 2500;       // N m at full brake
  float handbrake = 0.0f;   // N m
  float drive = 0.0f;       // share of the gearbox's torque; the shares of all wheels sum to 1, or to 0 without an engine
  TyreDef tyre{};
};

// Two wheels on one axle.
struct AxleDef {
  int left = 0, right = 1;  // wheels
  float anti_roll = 0.0f;   // N/m, of the difference in compression of the two springs
  float lock = 0.0f;        // N m by which the differential resists a difference of angular velocities; 0: open, 1e9: locked
};

// A point of the engine's torque curve.
struct TorquePoint {
  float speed = 0.0f;   // rad/s, of the engine
  float torque = 0.0f;  // N m at full throttle
};

struct EngineDef {
  std::vector<TorquePoint> curve{
      {80, 180}, {300, 260}, {500, 240}, {680, 160}};  // by ascending speed; constant beyond its ends
  float idle = 85;                                     // rad/s
  float redline = 680;                                 // rad/s: no fuel above it
  float inertia = 0.18f;                               // kg m^2
  float braking = 0.08f;                               // N m s/rad, without throttle
};

struct GearboxDef {
  std::vector<float> ratios{3.6f, 2.1f, 1.4f, 1.0f, 0.8f};
  float reverse = 3.4f;
  float final_ratio = 3.7f;
  float clutch = 500;        // N m, the largest torque that it transmits
  float shift_time = 0.25f;  // s, with the clutch open
  bool automatic = true;     // shifts by itself between first and last gear
  float shift_up = 580;      // rad/s of the engine
  float shift_down = 240;
};

// Wheels that a track forces to one speed.
struct TrackDef {
  std::vector<int> wheels{};
  float side = 1.0f;       // 1 on the left, -1 on the right
  float steering = 20000;  // N m that full lock adds on one side and subtracts on the other
};

// Keeps a two-wheeler upright: leans it into bends until gravity and the centripetal acceleration balance, like a rider. It is an external
// torque about the long axis. In a steady bend it is almost zero, since the wheels' forces pass through the centre of mass.
struct LeanDef {
  float frequency = 0.0f;  // Hz, of the lean; 0: no lean control. Above 1.5 for a vehicle as tall as a motorcycle
  float damping_ratio = 1.0f;
  float max_angle = 0.85f;  // rad; steering is limited so that no larger lean is needed
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
  std::uint32_t layers = 0xffffffffu;  // of shapes that the wheels roll on
};

struct WheelState {
  float angular_velocity = 0.0f;  // rad/s, about the axle
  float angle = 0.0f;        // rad, about the axle
  float steer = 0.0f;        // rad, to the left
  float compression = 0.0f;  // m
  float load = 0.0f;         // N
  float slip = 0.0f, slip_angle = 0.0f;
  Vec3 force{};  // N, of the tyre on the vehicle, world frame
  // A tyre that stands sticks to the ground: how far its foot is stretched, m, along the wheel and across it.
  bool stands = false;
  float stretch_along = 0.0f, stretch_across = 0.0f;
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
  float shifting = 0.0f;     // s, the time left of a shift
  float lean_torque = 0.0f;  // N m, in the last call
  float parked = 0.0f;       // s for which the vehicle has stood still with locked wheels
};

struct VehicleInput {
  float throttle = 0.0f;   // 0 to 1
  float brake = 0.0f;      // 0 to 1
  float handbrake = 0.0f;  // 0 to 1
  float steer = 0.0f;      // -1 (right) to 1 (left)
  int gear = 1;            // desired: -1, 0, or 1 and above; for an automatic gearbox everything above 0 means forward
  float clutch = 0.0f;     // 0 closed, 1 open
};

// The reason why a definition is invalid; code none if it is valid.
Error check_vehicle(const VehicleDef& def);

// A vehicle that has stood still for half a second with all wheels locked by its brakes falls asleep, if it touches no other body, and wakes
// when the input no longer holds it or the ground under it changes.
//
// Applies the forces of the wheels to the body for the next step, and advances wheels and engine by `seconds`. The opposite forces act on
// dynamic bodies that the wheels roll on. Returns an error, and changes nothing, if something is invalid.
Error drive_vehicle(World& world, const VehicleDef& def, BodyId body, VehicleState& state,
                    const VehicleInput& input, float seconds);

// The pose of a wheel: its centre, rotated by the steering angle and then about its axle (which points left) by `angle`.
Pose wheel_pose(const World& world, const VehicleDef& def, BodyId body, const VehicleState& state, int wheel);

}  // namespace gyre::kit
