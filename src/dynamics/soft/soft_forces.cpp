#include "dynamics/soft/soft_forces.h"

#include "dynamics/fluid/fluid_step.h"
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

// The flow past a place.
struct Flow {
  DVec3 velocity{};          // m/s
  double density = 0.0;      // kg/m^3
  double coefficient = 1.0;  // of drag
  double edge =
      0.0;  // m: of the cells of a fluid, which slows down as it pushes; 0: of a field, which does not
};

// Drag on faces and segments in a stream. Stream: bool operator()(DVec3 place, Flow& flow). `seconds`: for which fluids stay as they are.
template <class Stream>
class StreamForces {
 public:
  StreamForces(const Stream& stream, SoftEntry& entry, float h, float seconds, bool is_fluid)
      : stream_(stream),
        entry_(entry),
        p_(entry.body.particles),
        h_(double(h)),
        seconds_(double(seconds)),
        is_fluid_(is_fluid) {}

  void add() {
    for (std::size_t t = 0; t + 2 < entry_.triangles.size(); t += 3) add_face(&entry_.triangles[t]);
    if (entry_.kind != SoftKind::rope) return;
    for (int i = 0; i + 1 < p_.count; ++i) add_segment(i);
  }

 private:
  void push(int i, DVec3 force) {
    p_.fx[i] += float(force.x), p_.fy[i] += float(force.y), p_.fz[i] += float(force.z);
    if (is_fluid_) entry_.fluid_last[i] += h_ * force;
  }
  // The drag of a part of `mass` in the flow, if `size` times the speed of the flow times it is its force.
  DVec3 drag(double size, double mass, DVec3 flow, const Flow& stream) const {
    const double speed = length(flow);
    if (!(speed > 0.0) || !(mass > 0.0)) return {};
    double rate = size * speed;  // |F| / |w|
    // A layer of cells of the fluid would be turned round within the step.
    const double turned = stream.edge > 0.0 ? 0.5 * stream.coefficient * seconds_ * speed / stream.edge : 0.0;
    if (turned > 1.0) rate /= turned;
    return (rate / (1.0 + h_ * rate / mass)) * flow;
  }

  void add_face(const std::uint32_t* corner) {
    const int a = int(corner[0]), b = int(corner[1]), c = int(corner[2]);
    const DVec3 origin = p_.place(a), area = 0.5 * cross(p_.place(b) - origin, p_.place(c) - origin);
    const DVec3 middle = (1.0 / 3.0) * (origin + p_.place(b) + p_.place(c));
    Flow stream;
    if (!stream_(middle, stream)) return;
    const DVec3 own = (1.0 / 3.0) * (DVec3(p_.velocity(a)) + DVec3(p_.velocity(b)) + DVec3(p_.velocity(c)));
    const DVec3 flow = stream.velocity - own;
    const double speed = length(flow), through = dot(flow, area);
    if (!(speed > 0.0) || (entry_.kind == SoftKind::solid && through > 0.0)) return;
    const double shadow = absolute(through) / speed;
    const double mass = double(p_.mass[a]) + double(p_.mass[b]) + double(p_.mass[c]);
    const DVec3 force = drag(0.5 * stream.density * stream.coefficient * shadow, mass, flow, stream);
    for (const int i : {a, b, c}) push(i, (1.0 / 3.0) * force);
  }

  void add_segment(int i) {
    const DVec3 middle = 0.5 * (p_.place(i) + p_.place(i + 1)), along = p_.place(i + 1) - p_.place(i);
    const double span = length(along);
    Flow stream;
    if (!(span > 0.0) || !stream_(middle, stream)) return;
    const DVec3 own = 0.5 * (DVec3(p_.velocity(i)) + DVec3(p_.velocity(i + 1)));
    const DVec3 flow = stream.velocity - own, n = along / span;
    const DVec3 across = flow - dot(flow, n) * n;
    const double mass = double(p_.mass[i]) + double(p_.mass[i + 1]);
    const DVec3 force =
        drag(stream.density * stream.coefficient * double(entry_.radius) * span, mass, across, stream);
    push(i, 0.5 * force), push(i + 1, 0.5 * force);
  }

  const Stream& stream_;
  SoftEntry& entry_;
  Particles& p_;
  double h_, seconds_;
  bool is_fluid_;
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
  if (field.kind > FieldKind::buoyancy) return;  // those act on bodies
  if (field.linear_drag > 0.0f) add_linear_drag(field, entry, time, h);
  if (!(field.drag_coefficient > 0.0f) || !(field.density > 0.0f)) return;
  const auto stream = [&](DVec3 at, Flow& flow) {
    if (!acts_at(field, entry, at)) return false;
    flow = {stream_at(field, at, time).linear(), double(field.density), double(field.drag_coefficient), 0.0};
    return true;
  };
  StreamForces(stream, entry, h, 0.0f, false).add();
}

// m^3 that a kilogram of it fills.
double volume_per_mass(const SoftEntry& entry) {
  if (const auto* rope = std::get_if<RopeDef>(entry.def.get()))
    return kPi * double(rope->radius) * double(rope->radius) / double(rope->linear_density);
  if (const auto* cloth = std::get_if<ClothDef>(entry.def.get()))
    return double(cloth->thickness) / double(cloth->area_density);
  return 1.0 / double(std::get<SolidDef>(*entry.def).density);
}

// A liquid carries what it displaces.
void add_buoyancy(const FluidStore& fluids, DVec3 gravity, SoftEntry& entry, float h) {
  Particles& p = entry.body.particles;
  const double share = volume_per_mass(entry);
  for (int i = 0; i < p.count; ++i) {
    FluidStream stream;
    if (!find_stream(fluids, p.place(i), stream) || !stream.is_liquid) continue;
    const DVec3 force = (-share * double(p.mass[i]) * double(stream.density)) * gravity;
    p.fx[i] += float(force.x), p.fy[i] += float(force.y), p.fz[i] += float(force.z);
    entry.fluid_last[i] += double(h) * force;
  }
}

// `again`: the sub-step is tried once more, with other contacts.
void add_fluids(const FluidStore& fluids, DVec3 gravity, SoftEntry& entry, float h, float seconds,
                bool again) {
  const auto count = std::size_t(entry.body.particles.count);
  entry.fluid_sum.resize(count, DVec3{});
  if (!again)
    for (std::size_t i = 0; i < entry.fluid_last.size() && i < count; ++i)
      entry.fluid_sum[i] += entry.fluid_last[i];
  entry.fluid_last.clear();
  entry.fluid_last.resize(count, DVec3{});
  const auto stream = [&](DVec3 at, Flow& flow) {
    FluidStream found;
    if (!find_stream(fluids, at, found)) return false;
    flow = {DVec3(found.velocity), double(found.density), 1.0, double(found.edge)};
    return true;
  };
  StreamForces(stream, entry, h, seconds, true).add();
  add_buoyancy(fluids, gravity, entry, h);
}

}  // namespace

void set_field_forces(const RigidWorld& w, const FluidStore& fluids, SoftEntry& entry, double time, float h,
                      bool again) {
  Particles& p = entry.body.particles;
  for (Array<float>* const column : {&p.fx, &p.fy, &p.fz}) {
    for (float& force : *column) force = 0.0f;
  }
  for (const FieldRecord& field : w.fields) {
    if (field.is_live()) add_field(field, entry, time, h);
  }
  if (!fluids.empty())
    add_fluids(fluids, DVec3(w.settings.gravity), entry, h, h * float(w.settings.substeps), again);
}

}  // namespace gyre
