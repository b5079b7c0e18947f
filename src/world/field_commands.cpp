#include "dynamics/soft_contacts.h"
#include "world/field_commands.h"

#include "rigid/sleep/island.h"
#include "world/refusal.h"
#include "world/world_state.h"

#include <cstdio>

namespace gyre {

namespace {

constexpr std::size_t kMaxFields = 65536;

Error check_number(const char* field, double value, double low, double high) {
  if (is_finite(value) && value >= low && value <= high) return {};
  return refuse("%s is %g; it must lie within %g and %g", field, value, low, high);
}
Error check_place(const char* field, DVec3 p) {
  if (is_finite(p) && absolute(p.x) <= kMaxPosition && absolute(p.y) <= kMaxPosition &&
      absolute(p.z) <= kMaxPosition)
    return {};
  return refuse("%s is (%g, %g, %g); every component must be finite and within 1e12 m", field, p.x, p.y, p.z);
}
Error check_field_direction(const char* field, Vec3 v) {
  if (!is_finite(v))
    return refuse("%s is (%g, %g, %g); every component must be finite", field, double(v.x), double(v.y),
                  double(v.z));
  if (!(largest(absolute(v)) > 1.0e-37f)) return refuse("%s is zero; it must have a direction", field);
  return {};
}

struct NamedNumber {
  const char* name;
  double value, low, high;
};

Error check_def(const FieldDef& d) {
  if (d.kind > FieldKind::buoyancy) return refuse("field.kind is %d; there is no such kind", int(d.kind));
  Error e;
  if (d.bounds) {
    e = check_place("field.bounds.low", d.bounds->low);
    if (e.ok()) e = check_place("field.bounds.high", d.bounds->high);
    if (e) return e;
    const DVec3 low = d.bounds->low, high = d.bounds->high;
    if (!(low.x <= high.x && low.y <= high.y && low.z <= high.z)) {
      return refuse("field.bounds.low is (%g, %g, %g), in part above field.bounds.high (%g, %g, %g)", low.x,
                    low.y, low.z, high.x, high.y, high.z);
    }
  }
  const NamedNumber numbers[] = {
      {"field.velocity", double(largest(absolute(d.velocity))), 0.0, 1.0e6},
      {"field.velocity", double(d.velocity.x + d.velocity.y + d.velocity.z), -3.0e6, 3.0e6},
      {"field.density", double(d.density.value_or(1.0f)), 0.0, 1.0e20},
      {"field.drag_coefficient", double(d.drag_coefficient), 0.0, 1.0e6},
      {"field.linear_drag", double(d.linear_drag), 0.0, 1.0e6},
      {"field.turbulence", double(d.turbulence), 0.0, 1.0e3},
      {"field.turbulence_length", double(d.turbulence_length), 1.0e-6, 1.0e9},
      {"field.strength", double(d.strength), -1.0e9, 1.0e9},
      {"field.radius", double(d.radius), 1.0e-6, 1.0e9},
      {"field.falloff", double(d.falloff), -4.0, 4.0},
      {"field.core", double(d.core), 0.0, 1.0e9},
      {"field.offset", d.offset, -kMaxPosition, kMaxPosition},
  };
  for (const NamedNumber& n : numbers) {
    e = check_number(n.name, n.value, n.low, n.high);
    if (e) return e;
  }
  e = check_place("field.center", d.center);
  if (e.ok()) e = check_field_direction("field.axis", d.axis);
  return e.ok() ? check_field_direction("field.normal", d.normal) : e;
}

FieldId field_id(const WorldState& s, std::uint32_t slot) {
  return {slot, std::uint16_t(s.rigid.fields[slot].generation), s.number};
}

Error check_id(const WorldState& s, FieldId id, const char* what) {
  if (is_field(s, id)) return {};
  return make_error(ErrorCode::stale_id, "%s: field %u (generation %u) does not exist in this world", what,
                    id.index, unsigned(id.generation));
}

}  // namespace

bool is_field(const WorldState& s, FieldId id) {
  const Array<FieldRecord>& fields = s.rigid.fields;
  return id && id.world == s.number && id.index < fields.size() && fields[id.index].is_live() &&
         fields[id.index].generation == id.generation;
}

Error check(const WorldState& s, const AddField& c) {
  std::size_t live = 0;
  for (const FieldRecord& field : s.rigid.fields) live += field.is_live() ? 1 : 0;
  if (live >= kMaxFields) return refuse("add_field: a world has at most %d fields", int(kMaxFields));
  return check_def(c.def);
}
Error check(const WorldState& s, const SetField& c) {
  const Error e = check_id(s, c.field, "set_field");
  return e.ok() ? check_def(c.def) : e;
}
Error check(const WorldState& s, const RemoveField& c) { return check_id(s, c.field, "remove_field"); }
Error check(const WorldState&, const Explode& c) {
  const ExplosionDef& d = c.def;
  Error e = check_place("explosion.center", d.center);
  const NamedNumber numbers[] = {{"explosion.pressure", double(d.pressure), -1.0e20, 1.0e20},
                                 {"explosion.reference", double(d.reference), 1.0e-6, 1.0e9},
                                 {"explosion.falloff", double(d.falloff), 0.0, 4.0},
                                 {"explosion.radius", double(d.radius), 0.0, 1.0e9}};
  for (const NamedNumber& n : numbers) {
    if (e.ok()) e = check_number(n.name, n.value, n.low, n.high);
  }
  return e;
}

CommandResult execute(WorldState& s, const AddField& c) {
  Array<FieldRecord>& fields = s.rigid.fields;
  constexpr std::uint32_t kLastGeneration = 0xffff;
  std::uint32_t slot = 0;
  // A slot that has used up its generations is never used again.
  while (slot < fields.size() && (fields[slot].is_live() || fields[slot].generation >= kLastGeneration))
    ++slot;
  if (slot == fields.size()) fields.push_back({});
  const std::uint32_t generation = fields[slot].generation + 1;
  fields[slot] = make_field_record(c.def);
  fields[slot].generation = generation;
  wake_all(s.rigid), wake_all(s.soft);
  CommandResult out;
  out.done = true;
  out.field = field_id(s, slot);
  return out;
}
CommandResult execute(WorldState& s, const SetField& c) {
  FieldRecord& field = s.rigid.fields[c.field.index];
  const std::uint32_t generation = field.generation;
  field = make_field_record(c.def);
  field.generation = generation;
  wake_all(s.rigid), wake_all(s.soft);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const RemoveField& c) {
  FieldRecord& field = s.rigid.fields[c.field.index];
  const std::uint32_t generation = field.generation + 1;
  field = {};
  field.generation = generation;
  wake_all(s.rigid), wake_all(s.soft);
  return {true, {}, {}, {}};
}

const char* fault_in_fields(std::span<const FieldRecord> fields) {
  if (fields.size() > 2 * kMaxFields) return "too many fields";
  for (const FieldRecord& field : fields) {
    if (field.generation > 0x10000) return "a field whose generation is too large";
    if (!field.is_live()) continue;
    if (check_def(field_def(field))) return "a field that could not have been added";
  }
  return nullptr;
}

}  // namespace gyre
