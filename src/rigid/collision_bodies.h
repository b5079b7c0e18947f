// What contacts need to know of bodies while they are looked at, by body. Where most bodies rest only those are described that a contact
// which is asked has: what sleeps costs nothing.
#pragma once

#include "base/arena/arena.h"
#include "collision/contact/collide.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

#include <cstdint>
#include <span>

namespace gyre {

// Whether the body may be elsewhere when the step ends: contacts between bodies that may not are not looked at.
inline bool may_move(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  if (flags.awake == 0 || flags.frozen != 0 || flags.type == BodyType::fixed) return false;
  const BodyMotion& motion = w.bodies.motion[body];
  return flags.type == BodyType::dynamic || motion.linear_velocity != Vec3{} ||
         motion.angular_velocity != Vec3{};
}

class CollisionBodies {
 public:
  // Room in `arena`; `seconds` is how long the step lasts.
  CollisionBodies(const RigidWorld& w, Arena& arena, float seconds);

  void make(TaskSystem& tasks, Arena& arena);

  std::span<const CollisionBody> collision_bodies() const { return bodies_; }
  std::span<const BodyCenter> centers() const { return centers_; }
  std::span<const std::uint8_t> awake() const { return awake_; }

 private:
  std::size_t count() const { return w_.bodies.motion.size(); }
  // Bits by body.
  std::span<std::uint64_t> find_needed(Arena& arena) const;
  void describe(std::uint32_t i);

  const RigidWorld& w_;
  float seconds_;
  std::span<CollisionBody> bodies_;
  std::span<BodyCenter> centers_;
  std::span<std::uint8_t> awake_;
};

}  // namespace gyre
