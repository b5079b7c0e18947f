// Describes the bodies of active contacts. See collision_bodies.h.
#include "rigid/collision_bodies.h"

#include "task/parallel.h"

#include <bit>

namespace gyre {

namespace {

constexpr int kWordsPerBlock = 16;

}  // namespace

CollisionBodies::CollisionBodies(const RigidWorld& w, Arena& arena, float seconds)
    : w_(w),
      seconds_(seconds),
      bodies_(arena.make<CollisionBody>(count())),
      centers_(arena.make<BodyCenter>(count())),
      awake_(arena.make<std::uint8_t>(count())) {}

void CollisionBodies::make(TaskSystem& tasks, Arena& arena) {
  if (2 * w_.bodies.awake.size() >= count()) {
    for_blocks(tasks, int(count()), 4 * kBodiesPerBlock, [&](int begin, int end, int) {
      for (int i = begin; i < end; ++i) describe(std::uint32_t(i));
    });
    return;
  }
  const std::span<std::uint64_t> needed = find_needed(arena);
  for_blocks(tasks, int(needed.size()), kWordsPerBlock, [&](int begin, int end, int) {
    for (int word = begin; word < end; ++word)
      for (std::uint64_t left = needed[std::size_t(word)]; left != 0; left &= left - 1)
        describe(std::uint32_t(64 * word + std::countr_zero(left)));
  });
}

std::span<std::uint64_t> CollisionBodies::find_needed(Arena& arena) const {
  const std::span<std::uint64_t> needed = arena.make<std::uint64_t>((count() + 63) / 64);
  for (std::uint64_t& word : needed) word = 0;
  w_.active_constraints.contacts.for_each_set([&](std::size_t slot) {
    const Contact& contact = w_.contacts.contacts[slot];
    for (const std::uint32_t body : {contact.body_a, contact.body_b})
      needed[body / 64] |= std::uint64_t{1} << body % 64;
  });
  return needed;
}

void CollisionBodies::describe(std::uint32_t i) {
  const BodyMotion& motion = w_.bodies.motion[i];
  const BodyMass& mass = w_.bodies.masses[i];
  ColliderBody body;
  body.pose = origin_pose(w_.bodies, i);
  body.center = mass.center;
  body.linear_velocity = motion.linear_velocity;
  body.angular_velocity = motion.angular_velocity;
  body.bounding_radius = mass.bounding_radius;
  body.awake = can_move(w_, i);
  bodies_[i] = make_collision_body(body, seconds_);
  centers_[i] = {body.center, body.bounding_radius};
  awake_[i] = body.awake ? 1 : 0;
}

}  // namespace gyre
