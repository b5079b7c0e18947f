#include "dynamics/soft_forces.h"

#include "dynamics/fluid_step.h"
#include "rigid/field/medium.h"

namespace gyre {

namespace {

bool acts_at(const FieldRecord& field, const SoftEntry& entry, DVec3 at) {
  if (!field.is_live() || (field.layers & entry.settings().filter.layer) == 0) return false;
  if (field.kind == FieldKind::buoyancy && dot(DVec3(field.normal), at) > field.offset) return false;
  if (field.has_bounds == 0) return true;
  return at.x >= field.low.x && at.x <= field.high.x && at.y >= field.low.y && at.y <= field.high.y &&
         at.z >= field.low.z && at.z <= field.high.z;
}

// Drag on faces and segments in a stream. Stream: bool operator()(DVec3 place, DVec3& velocity, double& density, double& coefficient).
template <class Stream>
class StreamForces {
 public:
  StreamForces(const Stream& stream, SoftEntry& entry, float h)
      : stream_(stream), entry_(entry), p_(entry.body.particles), h_(double(h)) {}

  void add() {
    for (std::size_t t = 0; t + 2 < entry_.triangles.size(); t += 3) add_face(&entry_.triangles[t]);
    if (entry_.kind != SoftKind::rope) return;
    for (int i = 0; i + 1 < p_.count; ++i) add_segment(i);
  }

 private:
  void push(int i, DVec3 force) {
    p_.fx[i] += float(force.x), p_.fy[i] += float(force.y), p_.fz[i] += float(force.z);
  }
  // The drag of a part of `mass` in the flow, if `size` times the speed of the flow times it is its force.
  DVec3 drag(double size, double mass, DVec3 flow) const {
    const double speed = length(flow);
    if (!(speed > 0.0) || !(mass > 0.0)) return {};
    const double rate = size * speed;  // |F| / |w|
    return (rate / (1.0 + h_ * rate / mass)) * flow;
  }

  void add_face(const std::uint32_t* corner) {
    const int a = int(corner[0]), b = int(corner[1]), c = int(corner[2]);
    const DVec3 origin = p_.place(a), area = 0.5 * cross(p_.place(b) - origin, p_.place(c) - origin);
    const DVec3 middle = (1.0 / 3.0) * (origin + p_.place(b) + p_.place(c));
    DVec3 velocity;
    double density = 0.0, coefficient = 0.0;
    if (!stream_(middle, velocity, density, coefficient)) return;
    const DVec3 own = (1.0 / 3.0) * (DVec3(p_.velocity(a)) + DVec3(p_.velocity(b)) + DVec3(p_.velocity(c)));
    const DVec3 flow = velocity - own;
    const double speed = length(flow), through = dot(flow, area);
    if (!(speed > 0.0) || (entry_.kind == SoftKind::solid && through > 0.0)) return;
    const double shadow = absolute(through) / speed;
    const double mass = double(p_.mass[a]) + double(p_.mass[b]) + double(p_.mass[c]);
    const DVec3 force = drag(0.5 * density * coefficient * shadow, mass, flow);
    for (const int i : {a, b, c}) push(i, (1.0 / 3.0) * force);
  }

  void add_segment(int i) {
    const DVec3 middle = 0.5 * (p_.place(i) + p_.place(i + 1)), along = p_.place(i + 1) - p_.place(i);
    const double span = length(along);
    DVec3 velocity;
    double density = 0.0, coefficient = 0.0;
    if (!(span > 0.0) || !stream_(middle, velocity, density, coefficient)) return;
    const DVec3 own = 0.5 * (DVec3(p_.velocity(i)) + DVec3(p_.velocity(i + 1)));
    const DVec3 flow = velocity - own, n = along / span;
    const DVec3 across = flow - dot(flow, n) * n;
    const double mass = double(p_.mass[i]) + double(p_.mass[i + 1]);
    const DVec3 force = drag(density * coefficient * double(entry_.radius) * span, mass, across);
    push(i, 0.5 * force), push(i + 1, 0.5 * force);
  }

  const Stream& stream_;
  SoftEntry& entry_;
  Particles& p_;
  double h_;
};

void add_linear_drag(const FieldRecord& field, SoftEntry& entry, double time, float h) {
  Particles& p = entry.body.particles;
  const double rate = double(field.linear_drag), step = double(h);
  for (int i = 0; i < p.count; ++i) {
    const DVec3 at = p.place(i);
    if (!acts_at(field, entry, at)) continue;
    const DVec3 flow = stream_at(field, at, time).linear() - DVec3(p.velocity(i));
    const DVec3 force = (double(p.mass[i]) * rate / (1.0 + step * rate)) * flow;
    p.fx[i] += float(force.x), p.fy[i] += float(force.y), p.fz[i] += float(force.z);
  }
}
void add_attraction(const FieldRecord& field, SoftEntry& entry) {
  Particles& p = entry.body.particles;
  for (int i = 0; i < p.count; ++i) {
    const DVec3 at = p.place(i);
    if (!acts_at(field, entry, at)) continue;
    const DVec3 force = double(p.mass[i]) * radial_force_at(field, at).acceleration;
    p.fx[i] += float(force.x), p.fy[i] += float(force.y), p.fz[i] += float(force.z);
  }
}

void add_field(const FieldRecord& field, SoftEntry& entry, double time, float h) {
  if (field.kind == FieldKind::radial) return add_attraction(field, entry);
  if (field.linear_drag > 0.0f) add_linear_drag(field, entry, time, h);
  if (!(field.drag_coefficient > 0.0f) || !(field.density > 0.0f)) return;
  const auto stream = [&](DVec3 at, DVec3& velocity, double& density, double& coefficient) {
    if (!acts_at(field, entry, at)) return false;
    velocity = stream_at(field, at, time).linear();
    density = double(field.density), coefficient = double(field.drag_coefficient);
    return true;
  };
  StreamForces(stream, entry, h).add();
}

void add_gases(const FluidStore& fluids, SoftEntry& entry, float h) {
  const auto stream = [&](DVec3 at, DVec3& velocity, double& density, double& coefficient) {
    Vec3 wind;
    float weight = 0.0f;
    if (!find_wind(fluids, at, wind, weight)) return false;
    velocity = DVec3(wind), density = double(weight), coefficient = 1.0;
    return true;
  };
  StreamForces(stream, entry, h).add();
}

}  // namespace

void set_field_forces(const RigidWorld& w, const FluidStore& fluids, SoftEntry& entry, double time, float h) {
  Particles& p = entry.body.particles;
  for (Array<float>* const column : {&p.fx, &p.fy, &p.fz}) {
    for (float& force : *column) force = 0.0f;
  }
  for (const FieldRecord& field : w.fields) {
    if (field.is_live()) add_field(field, entry, time, h);
  }
  if (!fluids.empty()) add_gases(fluids, entry, h);
}

}  // namespace gyre
