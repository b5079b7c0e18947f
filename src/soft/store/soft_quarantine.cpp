#include "soft/store/soft_quarantine.h"

namespace gyre {

namespace {

bool is_sound(const Particles& p) {
  for (int i = 0; i < p.count; ++i)
    if (!is_finite(p.place(i)) || !is_finite(p.velocity(i))) return false;
  return true;
}

void freeze(SoftEntry& entry) {
  Particles& p = entry.body.particles;
  p.x = entry.good[0], p.y = entry.good[1], p.z = entry.good[2];
  for (int i = 0; i < p.count; ++i) p.set_velocity(i, {});
  forget_motion(entry);
  for (SoftAttachment& one : entry.attachments) one.impulse = {};
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
    if (entry.def == nullptr || !entry.is_awake() || is_sound(entry.body.particles)) continue;
    freeze(entry);
    frozen.push_back(slot);
  }
}

}  // namespace gyre
