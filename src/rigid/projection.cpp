#include "rigid/projection.h"

#include "rigid/free_rotation.h"
#include "rigid/integrators.h"

namespace gyre {

void begin_projection(BodyStore& bodies, std::span<const std::uint32_t> list, std::span<KeptVelocity> kept) {
  for (std::size_t n = 0; n < list.size(); ++n) {
    BodyMotion& motion = bodies.motion[list[n]];
    kept[n] = {motion.linear_velocity, motion.angular_velocity};
    motion.linear_velocity = motion.angular_velocity = {};
  }
}

void end_projection(BodyStore& bodies, std::span<const std::uint32_t> list, std::span<const KeptVelocity> kept) {
  for (std::size_t n = 0; n < list.size(); ++n) {
    const std::uint32_t i = list[n];
    const BodyFlags& flags = bodies.flags[i];
    BodyMotion& motion = bodies.motion[i];
    const Vec3 way = without_locked(motion.linear_velocity, flags.locked_linear);
    const Vec3 turn = without_locked(motion.angular_velocity, flags.locked_angular);
    motion.linear_velocity = kept[n].linear;
    motion.angular_velocity = kept[n].angular;
    if (flags.type != BodyType::dynamic || (way == Vec3{} && turn == Vec3{})) continue;
    motion.moved += way;
    motion.pushed = length(way) + bodies.masses[i].reach * length(turn);
    if (turn == Vec3{}) continue;
    motion.turned += rotate_steadily(bodies.orientations[i], turn, 1.0f);
    bodies.inertia[i] = world_inertia(bodies.masses[i], flags, bodies.orientations[i]);
  }
}

}  // namespace gyre
