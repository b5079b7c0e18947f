// read_bodies: the state of bodies as columns. See <gyre/debug.h>.
#include "base/float_mode.h"
#include "debug/flat.h"
#include "debug/islands.h"
#include "rigid/sleep/island.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

RestState rest_state(const BodyFlags& flags, const BodySleep& sleep) {
  if (is_disabled(flags)) return RestState::disabled;
  if (flags.frozen != 0) return RestState::frozen;
  if (flags.type == BodyType::fixed) return RestState::fixed;
  if (flags.type == BodyType::kinematic) return RestState::kinematic;
  if (flags.awake == 0) return RestState::asleep;
  return sleep.still_time > 0.0f ? RestState::resting : RestState::moving;
}

// Semi-axes of the solid ellipsoid with these principal moments: I_x = m (b^2 + c^2) / 5 and so on, solved for the squares.
Vec3 semi_axes(Vec3 moments, float mass) {
  if (!(mass > 0.0f)) return {};
  const float scale = 2.5f / mass;
  const auto side = [&](float opposite, float other, float own) {
    return std::sqrt(max(scale * (opposite + other - own), 0.0f));
  };
  return {side(moments.y, moments.z, moments.x), side(moments.x, moments.z, moments.y),
          side(moments.x, moments.y, moments.z)};
}

void add_body(const RigidWorld& w, std::uint32_t body, DVec3 origin, BodyTable& out) {
  const BodyPose& body_pose = w.bodies.poses[body];
  const BodyMotion& motion = w.bodies.motion[body];
  const BodyMass& mass = w.bodies.masses[body];
  const bool movable = is_movable(w.bodies.flags[body]);
  out.ids.push_back(body_id(w, body));
  append(out.centers, difference(body_pose.center, origin));
  if (movable) {
    const PrincipalAxes principal = principal_axes(mass.inertia);
    append(out.axes, normalized(body_pose.orientation * principal.orientation));
    append(out.semi_axes, semi_axes(principal.moments, mass.mass));
  } else {
    append(out.axes, body_pose.orientation);
    append(out.semi_axes, Vec3{});
  }
  append(out.linear_velocities, motion.linear_velocity);
  append(out.angular_velocities, motion.angular_velocity);
  const SleepTest rest = movable ? test_sleep(w, body, w.settings.last_step) : SleepTest{};
  out.speeds.push_back(rest.speed);
  out.rest_speeds.push_back(rest.rest_speed);
  out.still_times.push_back(w.bodies.sleep[body].still_time);
  out.states.push_back(rest_state(w.bodies.flags[body], w.bodies.sleep[body]));
}

}  // namespace

const char* to_string(RestState state) {
  switch (state) {
    case RestState::fixed:
      return "fixed";
    case RestState::kinematic:
      return "kinematic";
    case RestState::moving:
      return "moving";
    case RestState::resting:
      return "resting";
    case RestState::asleep:
      return "asleep";
    case RestState::frozen:
      return "frozen";
    case RestState::disabled:
      return "disabled";
  }
  return "unknown";
}

void read_bodies(const World& world, DVec3 origin, BodyTable& out) {
  const FloatMode mode;
  const RigidWorld& w = state_of(world).rigid;
  clear_all(out.ids, out.centers, out.axes, out.semi_axes, out.linear_velocities, out.angular_velocities, out.speeds,
            out.rest_speeds, out.still_times, out.states, out.islands, out.island_sizes);
  const IslandMap islands = find_islands(w);
  out.island_count = islands.count;
  w.bodies.ids.for_each_live([&](std::uint32_t body) {
    add_body(w, body, origin, out);
    const std::uint32_t root = islands.roots[body];
    out.islands.push_back(root);
    out.island_sizes.push_back(root == kNoIsland ? 0 : islands.sizes[root]);
  });
}

}  // namespace gyre
