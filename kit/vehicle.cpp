// Moves vehicles with wheels on springs, tyres and a drive line. In one call wheels find their ground, springs and anti-roll bars give
// loads, tyres and drive line advance together in short steps, and the body gets the mean of the tyres' forces.
//
// The drive line is stiff: a wheel's spin follows the ground within milliseconds, and faster at low speed. So each spin is integrated
// linearly implicitly in its own slip. Clutch and differentials are dampers, as stiff as is stable in a short step.
//
// Slip says nothing about a wheel that stands: there the foot of the tyre sticks to the ground and is stretched like a spring, up to the
// grip (Pacejka, chapter 7: at rest a tyre is a spring).
#include <gyre/kit/vehicle.h>

#include <gyre/debug.h>

namespace gyre::kit {

namespace {

constexpr int kShortSteps = 8;
// Least ground speed in the computation of slips, so that these stay finite at rest.
constexpr float kSlowest = 0.5f;  // m/s
// A tyre begins to stick below the first speed of its contact, and no longer does above the second.
constexpr float kSticks = 0.05f, kLetsGo = 0.2f;  // m/s
// A parked vehicle is still below these speeds, and falls asleep after this time.
constexpr float kParkedSpeed = 2.0e-3f, kParkedSpin = 2.0e-3f;  // m/s, rad/s
constexpr float kTimeToPark = 0.5f;                             // s

float clamp_to(float value, float most) { return value > most ? most : value < -most ? -most : value; }

float torque_at(const EngineDef& engine, float speed) {
  const std::vector<TorquePoint>& c = engine.curve;
  if (speed <= c.front().speed) return c.front().torque;
  for (std::size_t i = 1; i < c.size(); ++i) {
    if (speed > c[i].speed) continue;
    const float t = (speed - c[i - 1].speed) / (c[i].speed - c[i - 1].speed);
    return c[i - 1].torque + t * (c[i].torque - c[i - 1].torque);
  }
  return c.back().torque;
}

// Computes 2 s / (1 + s^2) up to the peak, then a fall to the sliding share.
float tyre_curve(const TyreDef& tyre, float s) {
  const float bell = 2.0f * s / (1.0f + s * s);
  return s <= 1.0f ? bell : tyre.slide + (1.0f - tyre.slide) * bell;
}

// A wheel on the ground in this call.
struct Rolling {
  Vec3 along{}, across{};  // unit, in the ground plane: rolling direction, and to its left
  float speed = 0.0f;      // m/s along, relative to the ground
  float side = 0.0f;       // m/s across
  float inertia = 0.0f;    // kg m^2, with the resistance of the ground to spin in a short step
  Vec3 sum{};              // sum of forces over the short steps
  float torque = 0.0f;     // N m, of the drive line in the last short step
};

class Drive {
 public:
  Drive(World& world, const VehicleDef& def, BodyId body, VehicleState& state, const VehicleInput& input,
        float seconds)
      : world_(world),
        def_(def),
        body_(body),
        s_(state),
        in_(input),
        seconds_(seconds),
        pose_(world.pose(body)),
        mass_(world.mass_properties(body).mass) {
    up_ = rotate(pose_.orientation, def.up);
    forward_ = rotate(pose_.orientation, def.forward);
  }

  void run() {
    steering_ = in_.steer * steering_limit();
    for (std::size_t i = 0; i < def_.wheels.size(); ++i) find_ground(i);
    share_loads();
    shift();
    const float h = seconds_ / float(kShortSteps);
    for (int k = 0; k < kShortSteps; ++k) turn_on(h);
    for (std::size_t i = 0; i < count(); ++i) stand(i);
    if (falls_asleep()) return;
    push();
    s_.lean_torque = 0.0f;
    if (def_.lean.frequency > 0.0f) lean();
  }

  // True if the vehicle is parked and nothing asks it to move; otherwise a parked one wakes.
  bool stays_asleep() {
    if (world_.is_awake(body_) || s_.parked < kTimeToPark) return false;
    steering_ = in_.steer * steering_limit();
    bool stays = in_.throttle == 0.0f && (def_.tracks.empty() || in_.steer == 0.0f);
    for (std::size_t i = 0; i < count() && stays; ++i) {
      const WheelState before = s_.wheels[i];
      find_ground(i);
      const WheelState& w = s_.wheels[i];
      stays = w.on_ground && w.ground == before.ground && is_still(w.ground) && is_braked(i, before.force) &&
              absolute(w.compression - before.compression) < 1.0e-3f &&
              absolute(w.steer - before.steer) < 1.0e-3f;
      s_.wheels[i] = before;
    }
    if (!stays) world_.set_awake(body_, true);
    return stays;
  }

 private:
  bool is_still(BodyId ground) const {
    return world_.type(ground) == BodyType::fixed ||
           (world_.type(ground) == BodyType::dynamic && !world_.is_awake(ground)) ||
           (world_.type(ground) == BodyType::kinematic && world_.linear_velocity(ground) == Vec3{} &&
            world_.angular_velocity(ground) == Vec3{});
  }
  // True if the brakes hold a wheel against a force.
  bool is_braked(std::size_t i, Vec3 force) const {
    return brake_torque(i) > def_.wheels[i].radius * length(force);
  }
  float brake_torque(std::size_t i) const {
    return in_.brake * def_.wheels[i].brake + in_.handbrake * def_.wheels[i].handbrake;
  }

  // The spring of the foot replaces the force of slip: across the wheel, and along it if the wheel is locked.
  void stand(std::size_t i) {
    const WheelDef& d = def_.wheels[i];
    WheelState& w = s_.wheels[i];
    const Rolling& r = rolling_[i];
    const float speed = max(absolute(r.speed), absolute(r.side));
    const bool was_standing = w.stands;
    w.stands = w.on_ground && w.load > 0.0f && speed < (was_standing ? kLetsGo : kSticks) &&
               absolute(w.angular_velocity) * d.radius < kLetsGo;
    if (!w.stands) {
      w.stretch_along = w.stretch_across = 0.0f;
      return;
    }
    const float share = mass_ / float(count());
    const float stiffness = 0.25f * share / square(seconds_), damping = 0.5f * share / seconds_;
    const Vec3 mean = (1.0f / float(kShortSteps)) * r.sum;
    float along = dot(mean, r.along), across = dot(mean, r.across);
    const bool locked = w.angular_velocity == 0.0f && brake_torque(i) > absolute(r.torque);
    // A tyre that begins to stick has the force that it had.
    if (was_standing) {
      w.stretch_across += seconds_ * r.side;
      w.stretch_along += seconds_ * r.speed;
      across = -stiffness * w.stretch_across - damping * r.side;
      if (locked) along = -stiffness * w.stretch_along - damping * r.speed;
    }
    const float holds = (brake_torque(i) - absolute(r.torque)) / d.radius;
    if (locked) along = clamp_to(along, holds);
    const float force = std::sqrt(square(along) + square(across)), most = d.tyre.grip * w.load;
    if (force > most) along *= most / force, across *= most / force;
    w.stretch_across = -(across + damping * r.side) / stiffness;
    w.stretch_along = locked ? -(along + damping * r.speed) / stiffness : 0.0f;
    rolling_[i].sum = float(kShortSteps) * (along * r.along + across * r.across);
  }

  // Puts a vehicle to sleep that stands still with locked wheels, on ground that does not move, touching nothing else.
  bool falls_asleep() {
    bool still = in_.throttle == 0.0f && length(world_.linear_velocity(body_)) < kParkedSpeed &&
                 length(world_.angular_velocity(body_)) < kParkedSpin;
    for (std::size_t i = 0; i < count(); ++i) {
      const WheelState& w = s_.wheels[i];
      still = still && w.stands && w.angular_velocity == 0.0f && is_still(w.ground) && is_braked(i, w.force);
    }
    s_.parked = still ? min(s_.parked + seconds_, 2.0f * kTimeToPark) : 0.0f;
    if (s_.parked < kTimeToPark) return false;
    const Explanation why = explain(world_, body_);
    const bool may = why.reason != AwakeReason::sleeping_off && why.reason != AwakeReason::may_not_sleep;
    if (may && why.island_bodies <= 1) return world_.set_awake(body_, false);
    s_.parked = 0.0f;  // asks again later
    return false;
  }

  // The steering angle of full lock; at speed it is limited to what the lean can follow.
  float steering_limit() const {
    if (!(def_.lean.frequency > 0.0f)) return def_.steer_angle;
    float front = -1.0e9f, rear = 1.0e9f;
    for (const WheelDef& wheel : def_.wheels) {
      front = max(front, dot(wheel.mount, def_.forward));
      rear = min(rear, dot(wheel.mount, def_.forward));
    }
    const SinCos most = sin_cos(def_.lean.max_angle);
    const float speed = dot(world_.linear_velocity(body_), forward_);
    const float angle =
        atan2((front - rear) * length(world_.gravity()) * most.sin, max(square(speed), 1.0e-6f) * most.cos);
    return min(angle, def_.steer_angle);
  }

  // Applies a spring and a damper that align the body with the sum of gravity and the bend's acceleration.
  void lean() {
    const Vec3 gravity = world_.gravity();
    const float pull = length(gravity);
    if (!(pull > 0.0f)) return;
    const Vec3 high = gravity / -pull;
    const Vec3 spin = world_.angular_velocity(body_);
    const float speed = dot(world_.linear_velocity(body_), forward_);
    const SinCos most = sin_cos(def_.lean.max_angle);
    const float bend = clamp_to(speed * dot(spin, high) / pull, most.sin / most.cos);
    const Vec3 target = normalized(high + bend * normalized(cross(high, forward_)));
    float height = 0.0f, touching = 0.0f;
    for (std::size_t i = 0; i < count(); ++i) {
      if (!s_.wheels[i].on_ground) continue;
      height += dot(difference(world_.center_of_mass(body_), s_.wheels[i].contact), up_);
      touching += 1.0f;
    }
    if (touching == 0.0f) return;
    height = height / touching;
    const Vec3 axis = rotate_inverse(pose_.orientation, forward_);
    // The body leans about the ground while tyres hold. Before they do, it rotates about its centre, so the stiffness is limited to what is
    // stable there in a step.
    const float alone = dot(axis, world_.mass_properties(body_).inertia * axis);
    const float whole = alone + mass_ * square(height);
    const float rate = 2.0f * kPi * def_.lean.frequency;
    const float stiffness = min(whole * square(rate), 0.2f * alone / square(seconds_));
    const float damping = min(2.0f * def_.lean.damping_ratio * rate * whole, 0.7f * alone / seconds_);
    s_.lean_torque = stiffness * dot(cross(up_, target), forward_) - damping * dot(spin, forward_);
    world_.add_torque(body_, s_.lean_torque * forward_);
  }

  std::size_t count() const { return def_.wheels.size(); }

  void find_ground(std::size_t i) {
    const WheelDef& d = def_.wheels[i];
    WheelState& w = s_.wheels[i];
    w.steer = d.steer * steering_;
    const DVec3 top = pose_ * d.mount + d.travel * up_;
    QueryFilter filter;
    filter.layers = def_.layers;
    filter.ignored = body_;
    filter.soft = false;  // wheels roll on bodies
    const float reach = d.travel + d.radius;
    const auto hit = world_.cast_ray(top, -reach * up_, filter);
    w.on_ground = hit && !hit->inside && dot(hit->normal, up_) > 0.1f;
    w.load = 0.0f;
    w.force = {};
    if (!w.on_ground) {
      w.compression = 0.0f;
      return;
    }
    w.contact = hit->point;
    w.normal = hit->normal;
    w.ground = hit->body;
    w.compression = reach - float(hit->fraction) * reach;
    roll_along(w, rolling_[i]);
  }

  void roll_along(const WheelState& w, Rolling& r) const {
    const SinCos turn = sin_cos(w.steer);
    const Vec3 left = cross(up_, forward_);
    const Vec3 heading = turn.cos * forward_ + turn.sin * left;
    r.along = normalized(heading - dot(heading, w.normal) * w.normal, forward_);
    r.across = cross(w.normal, r.along);
    const Vec3 v = world_.velocity_at(body_, w.contact) - world_.velocity_at(w.ground, w.contact);
    r.speed = dot(v, r.along);
    r.side = dot(v, r.across);
    r.sum = {};
  }

  // Computes the loads of springs, dampers and anti-roll bars. Stiffness and damping are limited to what is stable in a step for a body on
  // so many wheels.
  void share_loads() {
    const float share = mass_ / float(count());
    for (std::size_t i = 0; i < count(); ++i) {
      const WheelDef& d = def_.wheels[i];
      WheelState& w = s_.wheels[i];
      if (!w.on_ground) continue;
      const float stiffness = min(d.stiffness, 0.25f * share / square(seconds_));
      const float damping = min(d.damping, 0.5f * share / seconds_);
      const Vec3 v = world_.velocity_at(body_, w.contact) - world_.velocity_at(w.ground, w.contact);
      w.load = stiffness * w.compression - damping * dot(v, w.normal);
    }
    for (const AxleDef& axle : def_.axles) {
      WheelState &a = s_.wheels[axle.left], &b = s_.wheels[axle.right];
      const float roll = axle.anti_roll * (a.compression - b.compression);
      if (a.on_ground) a.load += roll;
      if (b.on_ground) b.load -= roll;
    }
    for (std::size_t i = 0; i < count(); ++i) s_.wheels[i].load = max(s_.wheels[i].load, 0.0f);
  }

  void shift() {
    if (s_.shifting > 0.0f) {
      s_.shifting = max(s_.shifting - seconds_, 0.0f);
      return;
    }
    const int last = int(def_.gearbox.ratios.size());
    int wanted = in_.gear < -1 ? -1 : in_.gear > last ? last : in_.gear;
    if (def_.gearbox.automatic && in_.gear > 0) {
      // The wheels decide, not an engine that is faster than a slipping clutch.
      const float geared = driven_speed();
      wanted = s_.gear > 0 ? s_.gear : 1;
      if (s_.gear > 0 && geared > def_.gearbox.shift_up && s_.gear < last) ++wanted;
      if (s_.gear > 1 && geared < def_.gearbox.shift_down) --wanted;
    }
    if (wanted == s_.gear) return;
    s_.gear = wanted;
    s_.shifting = def_.gearbox.shift_time;
  }

  // Revolutions of the engine for one revolution of the wheels.
  float ratio() const {
    const GearboxDef& g = def_.gearbox;
    if (s_.gear == 0) return 0.0f;
    return g.final_ratio * (s_.gear < 0 ? -g.reverse : g.ratios[std::size_t(s_.gear) - 1]);
  }

  // The speed of the engine without clutch slip.
  float driven_speed() const {
    float driven = 0.0f;
    for (std::size_t i = 0; i < count(); ++i)
      driven += def_.wheels[i].drive * s_.wheels[i].angular_velocity * ratio();
    return driven;
  }

  // The torque of the clutch on the gearbox: a damper, as stiff as is stable for the two sides, that slips above its limit.
  float clutch_torque(float h) const {
    const float gear = ratio();
    if (gear == 0.0f || s_.shifting > 0.0f) return 0.0f;
    float inverse = 1.0f / def_.engine.inertia;
    for (std::size_t i = 0; i < count(); ++i) {
      const WheelDef& d = def_.wheels[i];
      inverse += square(d.drive * gear) / rolling_[i].inertia;
    }
    // The clutch opens below one and a half times the idle speed, so that the engine does not stall.
    const float above = (s_.engine_speed - def_.engine.idle) / (0.5f * def_.engine.idle);
    const float grip = clamp(above, 0.0f, 1.0f);
    const float holds = def_.gearbox.clutch * (1.0f - in_.clutch) * grip;
    return clamp_to((s_.engine_speed - driven_speed()) / (h * inverse), holds);
  }

  void turn_engine(float h, float load) {
    const EngineDef& e = def_.engine;
    const float speed = s_.engine_speed;
    const float idle = speed < e.idle ? 0.3f : 0.0f;  // the governor's throttle
    const bool cut = speed > e.redline || s_.shifting > 0.0f;
    const float throttle = cut ? idle : max(in_.throttle, idle);
    const float made = throttle * torque_at(e, speed) - (1.0f - throttle) * e.braking * speed;
    s_.engine_speed = max(speed + h * (made - load) / e.inertia, 0.0f);
  }

  void turn_on(float h) {
    for (std::size_t i = 0; i < count(); ++i) {
      float slope = 0.0f;
      if (s_.wheels[i].on_ground) tyre(def_.wheels[i], s_.wheels[i], rolling_[i], slope);
      rolling_[i].inertia = def_.wheels[i].inertia + h * square(def_.wheels[i].radius) * slope;
    }
    const float clutch = clutch_torque(h), gear = ratio();
    float torque[VehicleState::kMaxWheels];
    for (std::size_t i = 0; i < count(); ++i) torque[i] = def_.wheels[i].drive * clutch * gear;
    for (const AxleDef& axle : def_.axles) {
      const float apart = s_.wheels[axle.left].angular_velocity - s_.wheels[axle.right].angular_velocity;
      const float across =
          clamp_to(apart / (h * (1.0f / rolling_[axle.left].inertia + 1.0f / rolling_[axle.right].inertia)),
                   axle.lock);
      torque[axle.left] -= across;
      torque[axle.right] += across;
    }
    for (const TrackDef& track : def_.tracks) {
      const float each = -track.side * in_.steer * track.steering / float(track.wheels.size());
      for (const int wheel : track.wheels) torque[wheel] += each;
    }
    for (std::size_t i = 0; i < count(); ++i) {
      rolling_[i].torque = torque[i];
      turn_wheel(i, torque[i], h);
    }
    for (const TrackDef& track : def_.tracks) bind(track);
    turn_engine(h, clutch);
  }

  // Gives all wheels of a track one speed and keeps their angular momentum.
  void bind(const TrackDef& track) {
    float momentum = 0.0f, inertia = 0.0f;
    for (const int wheel : track.wheels) {
      momentum += rolling_[wheel].inertia * s_.wheels[wheel].angular_velocity;
      inertia += rolling_[wheel].inertia;
    }
    for (const int wheel : track.wheels) s_.wheels[wheel].angular_velocity = momentum / inertia;
  }

  void turn_wheel(std::size_t i, float torque, float h) {
    const WheelDef& d = def_.wheels[i];
    WheelState& w = s_.wheels[i];
    Rolling& r = rolling_[i];
    float slope = 0.0f, pull = 0.0f;  // derivative of the tyre's force by the wheel's speed; the force along
    if (w.on_ground) pull = tyre(d, w, r, slope);
    const float inertia = r.inertia;
    w.angular_velocity += h * (torque - d.radius * pull) / inertia;
    // Brakes and rolling resistance stop the wheel and never reverse it.
    const float hold = in_.brake * d.brake + in_.handbrake * d.handbrake +
                       (w.on_ground ? d.tyre.rolling * w.load * d.radius : 0.0f);
    w.angular_velocity -= clamp_to(w.angular_velocity, h * hold / inertia);
    w.angle += h * w.angular_velocity;
    if (w.on_ground) {
      float unused = 0.0f;
      const float along = tyre(d, w, r, unused);
      r.sum += along * r.along + side_ * r.across;
    }
  }

  // Returns the force along, and leaves the force across in side_. By similarity, slips over the peak slips are one vector.
  float tyre(const WheelDef& d, WheelState& w, const Rolling& r, float& slope) {
    const float ground = max(absolute(r.speed), kSlowest);
    w.slip = (w.angular_velocity * d.radius - r.speed) / ground;
    w.slip_angle = atan2(r.side, ground);
    const float x = w.slip / d.tyre.peak_slip, y = -w.slip_angle / d.tyre.peak_angle;
    const float s = std::sqrt(x * x + y * y);
    const float most = d.tyre.grip * w.load;
    const float share = s > 1.0e-6f ? tyre_curve(d.tyre, s) / s : 2.0f;
    slope = most * share / (d.tyre.peak_slip * ground);
    // A force stops the mass on the wheel within the step at most.
    const float gravity = length(world_.gravity());
    const float bears = gravity > 0.0f ? w.load / (gravity * seconds_) : 0.0f;
    side_ = clamp_to(most * share * y, absolute(r.side) * bears);
    return clamp_to(most * share * x,
                    absolute(w.angular_velocity * d.radius - r.speed) * bears + most * 0.02f);
  }

  void push() {
    for (std::size_t i = 0; i < count(); ++i) {
      WheelState& w = s_.wheels[i];
      if (!w.on_ground) continue;
      w.force = (1.0f / float(kShortSteps)) * rolling_[i].sum;
      const Vec3 all = w.force + w.load * w.normal;
      world_.add_force_at(body_, all, w.contact);
      if (world_.type(w.ground) == BodyType::dynamic) world_.add_force_at(w.ground, -all, w.contact);
    }
  }

  World& world_;
  const VehicleDef& def_;
  BodyId body_;
  VehicleState& s_;
  const VehicleInput& in_;
  float seconds_;
  Pose pose_;
  float mass_;
  Vec3 up_, forward_;
  Rolling rolling_[VehicleState::kMaxWheels];
  float side_ = 0.0f;
  float steering_ = 0.0f;  // rad
};

Error refuse(const char* what, double value) {
  return make_error(ErrorCode::invalid_argument, "vehicle: %s is %g; it is out of range", what, value);
}
bool is_positive(float v) { return is_finite(v) && v > 0.0f; }
bool is_share(float v, float low) { return is_finite(v) && v >= low && v <= 1.0f; }

Error check_wheel(const WheelDef& d) {
  for (const float v : {d.radius, d.inertia, d.travel, d.stiffness, d.tyre.peak_slip, d.tyre.peak_angle}) {
    if (!is_positive(v))
      return refuse("a wheel's radius, inertia, travel, stiffness or slip of the peak", double(v));
  }
  for (const float v : {d.damping, d.brake, d.handbrake, d.tyre.grip, d.tyre.slide, d.tyre.rolling}) {
    if (!is_finite(v) || v < 0.0f) return refuse("a wheel's damping, brake, grip or resistance", double(v));
  }
  if (!is_finite(d.mount)) return refuse("a wheel's mount", double(d.mount.x));
  return is_share(d.drive, 0.0f) && is_share(d.steer, -1.0f)
             ? Error{}
             : refuse("a wheel's share of drive or steering", double(d.drive));
}

}  // namespace

Error check_vehicle(const VehicleDef& def) {
  const std::size_t count = def.wheels.size();
  if (count < 1 || count > std::size_t(VehicleState::kMaxWheels))
    return refuse("the number of wheels", double(count));
  if (!(absolute(length(def.forward) - 1.0f) < 1.0e-3f) || !(absolute(length(def.up) - 1.0f) < 1.0e-3f) ||
      !(absolute(dot(def.forward, def.up)) < 1.0e-3f)) {
    return refuse("the angle of forward and up, which are of length 1 and at right angles,",
                  double(dot(def.forward, def.up)));
  }
  for (const WheelDef& wheel : def.wheels) {
    const Error e = check_wheel(wheel);
    if (e) return e;
  }
  for (const AxleDef& axle : def.axles) {
    if (axle.left < 0 || axle.right < 0 || std::size_t(axle.left) >= count ||
        std::size_t(axle.right) >= count) {
      return refuse("an axle's wheel", double(axle.left));
    }
    if (!is_finite(axle.anti_roll) || axle.anti_roll < 0.0f || !(axle.lock >= 0.0f))
      return refuse("an axle's bar or lock", double(axle.lock));
  }
  for (const TrackDef& track : def.tracks) {
    if (track.wheels.empty() || !is_finite(track.steering))
      return refuse("a track's steering (or it has no wheels)", double(track.steering));
    for (const int wheel : track.wheels) {
      if (wheel < 0 || std::size_t(wheel) >= count) return refuse("a track's wheel", double(wheel));
    }
  }
  if (!(def.lean.frequency >= 0.0f && def.lean.frequency <= 10.0f) ||
      !(def.lean.max_angle > 0.0f && def.lean.max_angle < 1.5f)) {
    return refuse("the lean's frequency or angle", double(def.lean.frequency));
  }
  if (def.engine.curve.empty() || !is_positive(def.engine.inertia) || !is_positive(def.engine.idle)) {
    return refuse("the engine's inertia (or it has no torque curve)", double(def.engine.inertia));
  }
  for (std::size_t i = 1; i < def.engine.curve.size(); ++i) {
    if (!(def.engine.curve[i].speed > def.engine.curve[i - 1].speed))
      return refuse("a speed of the torque curve", double(def.engine.curve[i].speed));
  }
  for (const float ratio : def.gearbox.ratios) {
    if (!is_positive(ratio)) return refuse("a gear's ratio", double(ratio));
  }
  return def.gearbox.ratios.empty() ? refuse("the number of gears", 0.0) : Error{};
}

Error drive_vehicle(World& world, const VehicleDef& def, BodyId body, VehicleState& state,
                    const VehicleInput& input, float seconds) {
  const Error e = check_vehicle(def);
  if (e) return e;
  if (!world.exists(body))
    return make_error(ErrorCode::stale_id, "vehicle: body %u does not exist in this world", body.index);
  if (!(seconds > 0.0f && seconds <= 0.1f)) return refuse("seconds", double(seconds));
  if (!is_share(input.throttle, 0.0f) || !is_share(input.brake, 0.0f) || !is_share(input.handbrake, 0.0f) ||
      !is_share(input.clutch, 0.0f) || !is_share(input.steer, -1.0f)) {
    return refuse("an input (throttle among them)", double(input.throttle));
  }
  Drive drive(world, def, body, state, input, seconds);
  if (!drive.stays_asleep()) drive.run();
  return {};
}

Pose wheel_pose(const World& world, const VehicleDef& def, BodyId body, const VehicleState& state,
                int wheel) {
  const WheelDef& d = def.wheels[std::size_t(wheel)];
  const WheelState& w = state.wheels[wheel];
  const Pose pose = world.pose(body);
  const Vec3 middle = d.mount + w.compression * def.up;
  const Quat turn = from_axis_angle(def.up, w.steer) * from_axis_angle(cross(def.up, def.forward), w.angle);
  return {pose * middle, normalized(pose.orientation * turn)};
}

}  // namespace gyre::kit
