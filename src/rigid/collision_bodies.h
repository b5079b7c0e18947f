// The view of bodies that the narrow phase works on, by body. If most bodies sleep, only bodies of active contacts
// are described, so sleeping bodies cost nothing.
#pragma once

#include "base/arena/arena.h"
#include "collision/contact/collide.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

#include <cstdint>
#include <span>

namespace gyre {

// True if the body may move within the step. The narrow phase skips contacts between two bodies that do not.
inline bool can_move(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  if (flags.awake == 0 || flags.frozen != 0 || flags.type == BodyType::fixed) return false;
  const BodyMotion& motion = w.bodies.motion[body];
  return flags.type == BodyType::dynamic || motion.linear_velocity != Vec3{} ||
         motion.angular_velocity != Vec3{};
}

class CollisionBodies {
 public:
  // Memory comes from `arena`; `seconds` is the length of the step.
  CollisionBodies(const RigidWorld& w, Arena& arena, float seconds);

  void make(TaskSystem& tasks, Arena& arena);

  std::span<const CollisionBody> collision_bodies() const { return bodies_; }
  std::span<const BodyCenter> centers() const { return centers_; }
  std::span<const std::uint8_t> awake() const { return awake_; }

 private:
  std::size_t count() const { return w_.bodies.motion.size(); }
  // A bit for each body of an active contact.
  std::span<std::uint64_t> find_needed(Arena& arena) const;
  void describe(std::uint32_t i);

  const RigidWorld& w_;
  float seconds_;
  std::span<CollisionBody> bodies_;
  std::span<BodyCenter> centers_;
  std::span<std::uint8_t> awake_;
};

}  // namespace gyre
