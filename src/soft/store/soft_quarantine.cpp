#include "soft/store/soft_quarantine.h"

namespace gyre {

namespace {

bool is_sound(const Particles& p) {
  for (int i = 0; i < p.count; ++i)
    if (!is_finite(p.place(i)) || !is_finite(p.velocity(i))) return false;
  return true;
}

// The next step would begin with these impulses. A body that is frozen now leaves some that are not finite at vertices that are sound.
void forget_infinite_impulses(SoftEntry& entry) {
  const auto keep_finite = [](Vec3& impulse) {
    if (!is_finite(impulse)) impulse = {};
  };
  for_each_attachment(entry, [&](auto& one) { keep_finite(one.impulse); });
  for_each_contact(entry, [&](SoftContact& one) { keep_finite(one.impulse); });
}

void freeze(SoftEntry& entry) {
  Particles& p = entry.body.particles;
  p.x = entry.good[0], p.y = entry.good[1], p.z = entry.good[2];
  for (int i = 0; i < p.count; ++i) p.set_velocity(i, {});
  forget_motion(entry);
  for_each_attachment(entry, [&](auto& one) { one.impulse = {}; });
  for (double& tension : entry.body.chain.tension) tension = 0.0;
  entry.crossings = {};
  entry.rest[0] = {0.0f, kQuarantined};
}

}  // namespace

void keep_good_places(SoftStore& soft) {
  soft.for_each([](SoftEntry& entry) {
    if (!entry.is_awake()) return;
    const Particles& p = entry.body.particles;
    entry.good[0] = p.x, entry.good[1] = p.y, entry.good[2] = p.z;
  });
}

void quarantine_soft(SoftStore& soft, Array<std::uint32_t>& frozen) {
  for (std::uint32_t slot = 0; slot < soft.entries.size(); ++slot) {
    SoftEntry& entry = soft.entries[slot];
    if (entry.def == nullptr || !entry.is_awake()) continue;
    forget_infinite_impulses(entry);
    if (is_sound(entry.body.particles)) continue;
    freeze(entry);
    frozen.push_back(slot);
  }
}

}  // namespace gyre
