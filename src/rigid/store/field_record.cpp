#include "rigid/store/field_record.h"

namespace gyre {

const char* to_string(FieldKind kind) {
  switch (kind) {
    case FieldKind::wind:
      return "wind";
    case FieldKind::radial:
      return "radial";
    case FieldKind::vortex:
      return "vortex";
    case FieldKind::drag:
      return "drag";
    case FieldKind::buoyancy:
      return "buoyancy";
    case FieldKind::magnetic:
      return "magnetic";
    case FieldKind::magnetic_dipole:
      return "magnetic_dipole";
    case FieldKind::stokes:
      return "stokes";
    case FieldKind::grid:
      return "grid";
  }
  return "unknown";
}

FieldRecord make_field_record(const FieldDef& def) {
  FieldRecord r;
  r.kind = def.kind;
  r.has_bounds = def.bounds ? 1 : 0;
  if (def.bounds) r.low = def.bounds->low, r.high = def.bounds->high;
  r.layers = def.layers;
  r.velocity = def.velocity;
  r.density = def.density.value_or(def.kind == FieldKind::buoyancy ? 1000.0f : 1.2f);
  r.drag_coefficient = def.drag_coefficient;
  r.linear_drag = def.linear_drag;
  r.turbulence = def.turbulence;
  r.turbulence_length = def.turbulence_length;
  r.center = def.center;
  r.strength = def.strength;
  r.radius = def.radius;
  r.falloff = def.falloff;
  r.core = def.core;
  r.axis = normalized(def.axis);
  r.normal = normalized(def.normal);
  // The offset is for the normal of length 1: dot(normal, p) = offset.
  r.offset = def.offset;
  return r;
}

FieldDef field_def(const FieldRecord& r) {
  FieldDef def;
  def.kind = r.kind;
  if (r.has_bounds != 0) def.bounds = FieldBounds{r.low, r.high};
  def.layers = r.layers;
  def.velocity = r.velocity;
  def.density = r.density;
  def.drag_coefficient = r.drag_coefficient;
  def.linear_drag = r.linear_drag;
  def.turbulence = r.turbulence;
  def.turbulence_length = r.turbulence_length;
  def.center = r.center;
  def.strength = r.strength;
  def.radius = r.radius;
  def.falloff = r.falloff;
  def.core = r.core;
  def.axis = r.axis;
  def.normal = r.normal;
  def.offset = r.offset;
  return def;
}

}  // namespace gyre
