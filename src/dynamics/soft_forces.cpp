#include "dynamics/soft_forces.h"

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

class FieldForces {
 public:
  FieldForces(const FieldRecord& field, SoftEntry& entry, double time, float h)
      : field_(field), entry_(entry), p_(entry.body.particles), time_(time), h_(double(h)) {}

  void add() {
    if (field_.kind == FieldKind::radial) return add_attraction();
    if (field_.linear_drag > 0.0f) add_linear_drag();
    if (!(field_.drag_coefficient > 0.0f) || !(field_.density > 0.0f)) return;
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
    if (!acts_at(field_, entry_, middle)) return;
    const DVec3 own = (1.0 / 3.0) * (DVec3(p_.velocity(a)) + DVec3(p_.velocity(b)) + DVec3(p_.velocity(c)));
    const DVec3 flow = stream_at(field_, middle, time_).linear() - own;
    const double speed = length(flow), through = dot(flow, area);
    if (!(speed > 0.0) || (entry_.kind == SoftKind::solid && through > 0.0)) return;
    const double shadow = absolute(through) / speed;
    const double mass = double(p_.mass[a]) + double(p_.mass[b]) + double(p_.mass[c]);
    const DVec3 force =
        drag(0.5 * double(field_.density) * double(field_.drag_coefficient) * shadow, mass, flow);
    for (const int i : {a, b, c}) push(i, (1.0 / 3.0) * force);
  }

  void add_segment(int i) {
    const DVec3 middle = 0.5 * (p_.place(i) + p_.place(i + 1)), along = p_.place(i + 1) - p_.place(i);
    const double span = length(along);
    if (!(span > 0.0) || !acts_at(field_, entry_, middle)) return;
    const DVec3 own = 0.5 * (DVec3(p_.velocity(i)) + DVec3(p_.velocity(i + 1)));
    const DVec3 flow = stream_at(field_, middle, time_).linear() - own, n = along / span;
    const DVec3 across = flow - dot(flow, n) * n;
    const double mass = double(p_.mass[i]) + double(p_.mass[i + 1]);
    const DVec3 force =
        drag(double(field_.density) * double(field_.drag_coefficient) * double(entry_.radius) * span, mass,
             across);
    push(i, 0.5 * force), push(i + 1, 0.5 * force);
  }

  void add_linear_drag() {
    for (int i = 0; i < p_.count; ++i) {
      const DVec3 at = p_.place(i);
      if (!acts_at(field_, entry_, at)) continue;
      const DVec3 flow = stream_at(field_, at, time_).linear() - DVec3(p_.velocity(i));
      const double rate = double(field_.linear_drag);
      push(i, (double(p_.mass[i]) * rate / (1.0 + h_ * rate)) * flow);
    }
  }
  void add_attraction() {
    for (int i = 0; i < p_.count; ++i) {
      const DVec3 at = p_.place(i);
      if (acts_at(field_, entry_, at)) push(i, double(p_.mass[i]) * radial_force_at(field_, at).acceleration);
    }
  }

  const FieldRecord& field_;
  SoftEntry& entry_;
  Particles& p_;
  double time_, h_;
};

}  // namespace

void set_field_forces(const RigidWorld& w, SoftEntry& entry, double time, float h) {
  Particles& p = entry.body.particles;
  for (Array<float>* const column : {&p.fx, &p.fy, &p.fz}) {
    for (float& force : *column) force = 0.0f;
  }
  for (const FieldRecord& field : w.fields) {
    if (field.is_live()) FieldForces(field, entry, time, h).add();
  }
}

}  // namespace gyre
