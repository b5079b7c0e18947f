#include "soft/solver/sdirk_step.h"

namespace gyre {

namespace {

// The start of the second stage goes this far along the way from the start of the sub-step through the end of the first.
constexpr double kReach = (1.0 - kSdirkShare) / kSdirkShare;

}  // namespace

SdirkStages begin_sdirk(SoftBody& body, std::span<const CarriedInertia> carried, Arena& arena) {
  const Particles& p = body.particles;
  const std::size_t count = std::size_t(p.count);
  SdirkStages stages;
  stages.place = arena.make<DVec3>(count);
  stages.velocity = arena.make<Vec3>(count);
  stages.found = arena.make<Vec3>(count);
  stages.told = arena.make<DVec3>(body.held.size());
  stages.carried = arena.make<CarriedInertia>(carried.size());
  for (std::size_t i = 0; i < count; ++i) {
    stages.place[i] = p.place(int(i));
    stages.velocity[i] = p.velocity(int(i));
  }
  for (std::size_t k = 0; k < stages.told.size(); ++k) {
    HeldParticle& one = body.held[k];
    const DVec3 start = p.place(one.particle);
    stages.told[k] = one.place;
    one.place = start + kSdirkShare * (one.place - start);
  }
  stages.outside = arena.make<Vec3>(carried.size());
  for (std::size_t k = 0; k < carried.size(); ++k) {
    const int i = carried[k].particle;
    stages.carried[k] = carried[k];
    stages.outside[k] = {p.fx[i], p.fy[i], p.fz[i]};
  }
  return stages;
}

void turn_sdirk(SoftBody& body, SdirkStages& stages) {
  Particles& p = body.particles;
  for (std::size_t k = 0; k < stages.carried.size(); ++k) {
    CarriedInertia& one = stages.carried[k];
    const int i = one.particle;
    one.target += float(kReach) * (p.velocity(i) - one.target);
    p.fx[i] = stages.outside[k].x, p.fy[i] = stages.outside[k].y, p.fz[i] = stages.outside[k].z;
  }
  for (int i = 0; i < p.count; ++i) {
    const DVec3 place = stages.place[std::size_t(i)];
    const Vec3 velocity = stages.velocity[std::size_t(i)];
    p.set_place(i, place + kReach * (p.place(i) - place));
    p.set_velocity(i, velocity + float(kReach) * (p.velocity(i) - velocity));
  }
  for (std::size_t k = 0; k < stages.told.size(); ++k) body.held[k].place = stages.told[k];
}

void end_sdirk(const SoftBody& body, SdirkStages& stages) {
  for (std::size_t i = 0; i < stages.found.size(); ++i) stages.found[i] = body.particles.velocity(int(i));
}

void move_by_impulses(SoftBody& body, const SdirkStages& stages, double step) {
  Particles& p = body.particles;
  for (int i = 0; i < p.count; ++i) {
    if (p.loose[i] == 0.0f) continue;
    const DVec3 change(p.velocity(i) - stages.found[std::size_t(i)]);
    p.set_place(i, p.place(i) + (1.0 - kSdirkShare) * step * change);
  }
}

}  // namespace gyre
