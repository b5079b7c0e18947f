#include "dynamics/soft/soft_contacts.h"
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
  if (int(d.kind) >= kFieldKindCount) return refuse("field.kind is %d; there is no such kind", int(d.kind));
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
  if (d.kind == FieldKind::stokes && d.strength < 0.0f)
    return refuse("field.strength, the viscosity, is %g; it must not be below 0", double(d.strength));
  e = check_place("field.center", d.center);
  if (e.ok()) e = check_field_direction("field.axis", d.axis);
  return e.ok() ? check_field_direction("field.normal", d.normal) : e;
}


constexpr int kMaxGridPoints = 1024;
constexpr std::size_t kMaxGridVectors = std::size_t(1) << 22;

bool is_grid_size(const int (&points)[3], std::size_t vectors) {
  std::size_t count = 1;
  for (const int n : points) {
    if (n < 2 || n > kMaxGridPoints) return false;
    count *= std::size_t(n);
  }
  return count <= kMaxGridVectors && count == vectors;
}

Error check_grid(const FieldDef& d) {
  if (d.kind != FieldKind::grid) {
    return d.vectors.empty() ? Error{} : refuse("field.vectors: only a field of kind grid has them");
  }
  if (!d.bounds) return refuse("field.bounds must be given: the grid stands in them");
  if (!is_grid_size({d.points[0], d.points[1], d.points[2]}, d.vectors.size()))
    return refuse("field.points is (%d, %d, %d), with %d vectors; it must be 2 to %d each, %d in all, and one vector each",
                  d.points[0], d.points[1], d.points[2], int(d.vectors.size()), kMaxGridPoints, int(kMaxGridVectors));
  for (const Vec3& v : d.vectors)
    if (!is_finite(v) || !(largest(absolute(v)) <= 1.0e9f))
      return refuse("field.vectors has (%g, %g, %g); every component must lie within -1e9 and 1e9", double(v.x),
                    double(v.y), double(v.z));
  return {};
}

// Removes the grid of a field, and gives it that of a definition.
void set_grid(RigidWorld& w, std::uint32_t slot, const FieldDef* def) {
  if (slot < w.field_grids.size() && w.field_grids[slot].count > 0) {
    const FieldGrid old = w.field_grids[slot];
    w.field_grids[slot] = {};
    for (std::size_t i = old.first; i + old.count < w.field_vectors.size(); ++i)
      w.field_vectors[i] = w.field_vectors[i + old.count];
    w.field_vectors.resize(w.field_vectors.size() - old.count);
    for (FieldGrid& other : w.field_grids)
      if (other.count > 0 && other.first > old.first) other.first -= old.count;
  }
  if (def == nullptr || def->kind != FieldKind::grid) return;
  if (slot >= w.field_grids.size()) w.field_grids.resize(slot + 1);
  FieldGrid& grid = w.field_grids[slot];
  grid.first = std::uint32_t(w.field_vectors.size()), grid.count = std::uint32_t(def->vectors.size());
  for (std::size_t i = 0; i < 3; ++i) grid.points[i] = def->points[i];
  for (const Vec3& v : def->vectors) w.field_vectors.push_back({v});
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
  const Error e = check_def(c.def);
  return e.ok() ? check_grid(c.def) : e;
}
Error check(const WorldState& s, const SetField& c) {
  Error e = check_id(s, c.field, "set_field");
  if (e.ok()) e = check_def(c.def);
  return e.ok() ? check_grid(c.def) : e;
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
  set_grid(s.rigid, slot, &c.def);
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
  set_grid(s.rigid, c.field.index, &c.def);
  wake_all(s.rigid), wake_all(s.soft);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const RemoveField& c) {
  FieldRecord& field = s.rigid.fields[c.field.index];
  const std::uint32_t generation = field.generation + 1;
  field = {};
  field.generation = generation;
  set_grid(s.rigid, c.field.index, nullptr);
  wake_all(s.rigid), wake_all(s.soft);
  return {true, {}, {}, {}};
}

const char* fault_in_fields(const RigidWorld& w) {
  const std::span<const FieldRecord> fields = w.fields;
  std::size_t vectors = 0;
  for (std::size_t slot = 0; slot < w.field_grids.size(); ++slot) {
    const FieldGrid& grid = w.field_grids[slot];
    if (slot >= fields.size()) return "a grid without a field";
    if (grid.count == 0) continue;
    if (fields[slot].kind != FieldKind::grid || !is_grid_size(grid.points, grid.count) ||
        std::size_t(grid.first) + grid.count > w.field_vectors.size())
      return "a grid that no field could have";
    vectors += grid.count;
  }
  if (vectors != w.field_vectors.size()) return "vectors of no grid";
  for (const FieldVector& v : w.field_vectors)
    if (!is_finite(v.value)) return "a vector of a field that is not finite";
  if (fields.size() > 2 * kMaxFields) return "too many fields";
  for (const FieldRecord& field : fields) {
    if (field.generation > 0x10000) return "a field whose generation is too large";
    if (!field.is_live()) continue;
    if (check_def(field_def(field))) return "a field that could not have been added";
    const std::size_t slot = std::size_t(&field - fields.data());
    if (field.kind == FieldKind::grid && (slot >= w.field_grids.size() || w.field_grids[slot].count == 0))
      return "a field without its grid";
  }
  return nullptr;
}

FieldDef World::field(FieldId id) const {
  if (!exists(id)) return {};
  const RigidWorld& w = state_->rigid;
  FieldDef def = field_def(w.fields[id.index]);
  if (def.kind != FieldKind::grid) return def;
  const FieldGrid& grid = w.field_grids[id.index];
  for (std::size_t i = 0; i < 3; ++i) def.points[i] = grid.points[i];
  def.vectors.reserve(grid.count);
  for (std::size_t i = 0; i < grid.count; ++i) def.vectors.push_back(w.field_vectors[grid.first + i].value);
  return def;
}

}  // namespace gyre
