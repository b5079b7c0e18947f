// A force field as the world stores it: plain numbers, directions of length 1. It occupies a slot with a generation.
// The lowest free slot is used first; a generation is odd while its slot is in use.
#pragma once

#include <gyre/fields.h>

namespace gyre {

struct FieldRecord {
  std::uint32_t generation = 0;
  FieldKind kind = FieldKind::wind;
  std::uint8_t has_bounds = 0;
  std::uint32_t layers = 0;
  DVec3 low, high;  // bounds
  Vec3 velocity;
  float density = 0.0f;
  float drag_coefficient = 0.0f;
  float linear_drag = 0.0f;
  float turbulence = 0.0f;
  float turbulence_length = 1.0f;
  DVec3 center;
  float strength = 0.0f;
  float radius = 1.0f;
  float falloff = 0.0f;
  float core = 0.0f;
  Vec3 axis;
  Vec3 normal;
  double offset = 0.0;

  bool is_live() const { return (generation & 1) != 0; }
  bool is_medium() const {
    return kind == FieldKind::stokes || (kind <= FieldKind::buoyancy && kind != FieldKind::radial);
  }
  bool is_magnetic() const { return kind == FieldKind::magnetic || kind == FieldKind::magnetic_dipole; }
};

// The grid of a field of kind grid: a part of the list of all vectors.
struct FieldGrid {
  std::uint32_t first = 0, count = 0;
  std::int32_t points[3] = {};
};
struct FieldVector {
  Vec3 value;
};

// `def` must have passed the checks. The caller sets the generation.
FieldRecord make_field_record(const FieldDef& def);
FieldDef field_def(const FieldRecord& record);

}  // namespace gyre
