#include "soft/solver/vertex_limits.h"

namespace gyre {

namespace {

// Moves a vertex to `place`, along `out` from which it comes: it does not move on that way.
void put(SoftEntry& entry, int i, DVec3 place, DVec3 out) {
  Particles& p = entry.body.particles;
  const DVec3 moved = place - p.place(i);
  p.set_place(i, place);
  const Vec3 normal = to_float(out);
  const float along = dot(p.velocity(i), normal);
  if (along > 0.0f) p.set_velocity(i, p.velocity(i) - along * normal);
  Array<double>(&kept)[3] = entry.body.moved;
  if (!kept[0].empty()) kept[0][i] += moved.x, kept[1][i] += moved.y, kept[2][i] += moved.z;
}

}  // namespace

void keep_limits(SoftEntry& entry) {
  const Particles& p = entry.body.particles;
  for (int i = 0; i < int(entry.limits.size()) && i < p.count; ++i) {
    const SoftLimit& limit = entry.limits[i];
    if (p.loose[i] == 0.0f) continue;
    if (limit.normal != Vec3{}) {
      const DVec3 normal(limit.normal);
      const double behind = -dot(normal, p.place(i) - limit.target) - double(limit.backstop);
      if (behind > 0.0) put(entry, i, p.place(i) + behind * normal, -normal);
    }
    if (limit.distance < 0.0f) continue;
    const DVec3 way = p.place(i) - limit.target;
    const double far = length(way);
    if (far > double(limit.distance))
      put(entry, i, limit.target + (double(limit.distance) / far) * way, way / far);
  }
}

}  // namespace gyre
