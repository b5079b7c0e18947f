// See motion_hash.h. The rounds of XXH64 over eight words a body, four lanes at a time.
#include "io/snapshot/motion_hash.h"

#include "base/hash.h"

#include <bit>
#include <cstring>

namespace gyre {

namespace {

std::uint64_t word_of(double value) { return __builtin_bit_cast(std::uint64_t, value); }

// Two adjacent floats, by one load where the byte order allows it.
std::uint64_t word_of(const float* two) {
  std::uint64_t word = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&word, two, sizeof word);
  } else {
    for (int i = 0; i < 2; ++i) word |= std::uint64_t(__builtin_bit_cast(std::uint32_t, two[i])) << 32 * i;
  }
  return word;
}

void hash_body(hash_detail::Lanes& lanes, const BodyMotion& motion, const BodyPose& pose) {
  static_assert(kMotionLinear == 0 && kMotionAngular == 3, "six floats in a row");
  const float* const velocities = reinterpret_cast<const float*>(&motion);
  const float* const quaternion = reinterpret_cast<const float*>(&pose.orientation);
  lanes.update(word_of(velocities), word_of(velocities + 2), word_of(velocities + 4), word_of(pose.center.x));
  lanes.update(word_of(pose.center.y), word_of(pose.center.z), word_of(quaternion), word_of(quaternion + 2));
}

// Eight numbers at a time; those that are left over at the end are ghosts of a grid or a few of many particles.
void hash_field(hash_detail::Lanes& lanes, const Array<float>& field) {
  const float* const values = field.data();
  for (std::size_t i = 0; i + 8 <= field.size(); i += 8)
    lanes.update(word_of(values + i), word_of(values + i + 2), word_of(values + i + 4), word_of(values + i + 6));
}

}  // namespace

std::uint64_t hash_motion(const WorldState& state) {
  const BodyStore& bodies = state.rigid.bodies;
  hash_detail::Lanes lanes(state.step_count);
  for (const std::uint32_t i : bodies.awake) hash_body(lanes, bodies.motion[i], bodies.poses[i]);
  state.soft.for_each([&](const SoftEntry& entry) {
    const Particles& p = entry.body.particles;
    for (int i = 0; i < p.count; ++i) {
      lanes.update(word_of(p.x[i]), word_of(p.y[i]), word_of(p.z[i]),
                   std::uint64_t(__builtin_bit_cast(std::uint32_t, p.vx[i])) ^
                       std::uint64_t(__builtin_bit_cast(std::uint32_t, p.vy[i])) << 16 ^
                       std::uint64_t(__builtin_bit_cast(std::uint32_t, p.vz[i])) << 32);
    }
  });
  state.fluids.for_each([&](const FluidEntry& entry) {
    for (const Array<float>& faces : entry.gas.velocity) hash_field(lanes, faces);
    for (const Array<float>& column : entry.liquid.position) hash_field(lanes, column);
  });
  const std::uint64_t counts = std::uint64_t(bodies.awake.size()) << 32 | state.rigid.contacts.live;
  return mix_bits(lanes.merge() ^ mix_bits(counts ^ mix_bits(word_of(state.time))));
}

}  // namespace gyre
