#include "dynamics/soft/soft_surfaces.h"

#include "dynamics/soft/soft_groups.h"
#include "dynamics/soft/soft_rounds.h"
#include "dynamics/soft/soft_solve.h"
#include "soft/contact/surface_crossings.h"
#include "soft/solver/coupled_solve.h"
#include "soft/solver/rigid_modes.h"
#include "soft/solver/soft_pass.h"

namespace gyre {

namespace {

// A solid is stiff if the blocks of its vertices have more than so many times their mass: a vertex that the bounds stop gives the solid so many times the energy
// that it had.
constexpr double kStiffShare = 100.0;
// A vertex that began inside a shape and does not move is pushed out by so many times its weight. More would press a stiff solid out of shape where its vertices are nearest to
// different sides of the shape.
constexpr float kEmergeWeights = 5.0f;
// An attached point may miss the motion of what holds it by this share of what gravity gives in the sub-step.
constexpr float kHoldShare = 0.03f;
// Errors of what moves more slowly than this share of what gravity gives in the sub-step do not matter. With 0.1 a sheet that friction holds on a slope creeps by 0.1 mm in two seconds.
constexpr float kRestShare = 0.03f;
// A contact that still closes faster than this share of what gravity gives in the sub-step is not met.
constexpr float kUnmetShare = 1.0f;
// Normals with a lower product press from opposite sides.
constexpr float kOpposite = 0.0f;

SoftWork& work_at(SoftSolve& s, std::uint32_t member) { return *s.scratch->works[s.members[member]]; }
SoftEntry& entry_at(SoftSolve& s, std::uint32_t member) { return s.store->entries[s.members[member]]; }

// Calls fn(member, first vertex) for each surface.
template <class Fn>
void for_each_surface(SoftSurfaces& all, Fn&& fn) {
  for (std::size_t i = 0; i < all.placed.size(); ++i) fn(all.member[i], all.placed[i].first);
}

// Calls fn(member, first vertex) for each member whose contacts are solved here.
template <class Fn>
void for_each_member(SoftSurfaces& all, Fn&& fn) {
  for_each_surface(all, fn);
  for (std::size_t i = 0; i < all.others.size(); ++i) fn(all.others[i], all.other_first[i]);
}

SurfaceContactSettings settings_of(const SoftSolve& s) {
  SurfaceContactSettings settings;
  settings.step = s.h;
  settings.gravity = reference_gravity(s.w->settings);
  return settings;
}
SurfaceVertices vertices_of(SoftSurfaces& all) {
  const std::size_t count = all.positions.size();
  return {all.positions, all.velocities.view().first(count), all.inverse_mass.view().first(count),
          all.blocks.view().first(count), all.stiff.view().first(count)};
}

void gather_velocities(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  for_each_member(all, [&](std::uint32_t member, std::uint32_t first) {
    const Particles& p = entry_at(s, member).body.particles;
    for (int i = 0; i < p.count; ++i) all.velocities[first + std::uint32_t(i)] = p.velocity(i);
  });
}

// The momentum that the parts carried by a member's vertices gain from the change of its velocities.
void add_carried_change(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_at(s, member);
  for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
    SoftRow& row = s.scratch->rows[k];
    if (row.carried >= 0)
      row.carried_step += -(s.scratch->carried[row.carried].inertia * work.change[row.particle]);
  }
}

// How vertices answer impulses, and the pieces that are stiff.
void find_responses(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  std::uint32_t pieces = 0;
  for_each_member(all, [&](std::uint32_t member, std::uint32_t first) {
    const SoftEntry& entry = entry_at(s, member);
    const SoftWork& work = work_at(s, member);
    const Particles& p = entry.body.particles;
    double bare = 0.0, own = 0.0;
    for (std::uint32_t i = 0; i < std::uint32_t(p.count); ++i) {
      const Sym3 block = inverse_mass(entry, work.step, i);
      all.inverse_mass[first + i] = p.loose[i] == 0.0f ? 0.0f : 1.0f / p.mass[i];
      all.blocks[first + i] = block;
      bare += double(all.inverse_mass[first + i]);
      own += (1.0 / 3.0) * double(block.xx + block.yy + block.zz);
    }
    const bool is_stiff = entry.kind == SoftKind::solid && entry.body.held.empty() &&
                          work.step.method == SoftMethod::conjugate_gradients && bare > kStiffShare * own;
    for (std::uint32_t i = 0; i < std::uint32_t(p.count); ++i)
      all.stiff[first + i] = is_stiff ? pieces + std::uint32_t(entry.body.piece_of(int(i))) : kNoStiffPiece;
    pieces += std::uint32_t(entry.body.pieces());
  });
}

// The inertia of the bodies that may yield, by their number among those that are touched.
std::span<const RigidInertia> gather_rigid(SoftSolve& s) {
  SoftScratch& scratch = *s.scratch;
  const std::span<RigidInertia> rigid = scratch.surfaces.arena.make<RigidInertia>(scratch.touched.size());
  for (std::size_t k = 0; k < rigid.size(); ++k) {
    const BodyInertia& inertia = s.w->bodies.inertia[scratch.touched[k]];
    const float inverse = inertia.inverse_mass;
    rigid[k] = {along_free_axes(inertia, {inverse, inverse, inverse}), inertia.inverse};
  }
  return rigid;
}

// The coupling row of a contact with a shape, or of a point that a body holds.
CouplingRow coupling_row(SoftSolve& s, const SoftRow& row, std::uint32_t first) {
  CouplingRow out;
  int k = 0;
  for (std::uint32_t& v : out.vertex) v = first + row.particle;
  float mobility = 0.0f;
  for_each_vertex(row, [&](std::uint32_t v, float weight) {
    out.vertex[k] = first + v, out.weight[k++] = weight;
    mobility += weight * weight * s.scratch->surfaces.inverse_mass[first + v];
  });
  if (row.pushes && row.body_compliance != Sym3{}) out.body = row.touched;
  out.arm = row.arm;
  out.impulse = row.impulse;
  if (row.kind == SoftRowKind::point) {
    out.holds = true;
    out.passing = velocity_of_body(s, row) - row.bias;
    out.normal = row.normal;
    out.slow = out.allowed = kHoldShare * s.h * reference_gravity(s.w->settings);
    return out;
  }
  const float wanted = dot(row.normal, row.bias);
  out.passing = velocity_of_body(s, row) - (row.bias - wanted * row.normal);
  out.normal = row.normal, out.target = -wanted;
  out.friction[0] = row.static_friction, out.friction[1] = row.dynamic_friction;
  out.slides = row.grip == SoftGrip::slides;
  out.slow = out.allowed = kUnmetShare * s.h * reference_gravity(s.w->settings);
  if (row.grip == SoftGrip::emerges && out.target > 0.0f)
    out.damper = kEmergeWeights * s.h * reference_gravity(s.w->settings) / (mobility * out.target);
  return out;
}

// Appends the rows of contacts with shapes to those of surfaces; returns their numbers among all rows of the step.
std::span<const std::uint32_t> add_shape_rows(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  const std::span<std::uint32_t> numbers = all.arena.make<std::uint32_t>(s.scratch->rows.size());
  std::size_t used = 0;
  for_each_member(all, [&](std::uint32_t member, std::uint32_t first) {
    const SoftWork& work = work_at(s, member);
    for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
      const SoftRow& row = s.scratch->rows[k];
      bool moves = row.body_compliance != Sym3{};
      for_each_vertex(row,
                      [&](std::uint32_t v, float) { moves = moves || all.inverse_mass[first + v] > 0.0f; });
      if (!row.coupled || !moves) continue;
      all.contacts.rows.push_back(coupling_row(s, row, first));
      numbers[used++] = k;
    }
  });
  return numbers.first(used);
}

// True if bodies that do not yield press a vertex of a member from opposite sides, and one of them less quickly out of it than it is to.
bool is_squeezed(SoftSolve& s, std::span<const std::uint32_t> numbers, std::span<const CouplingRow> rows) {
  SoftSurfaces& all = s.scratch->surfaces;
  const ArenaScope scope(all.arena);
  const SoftEntry& entry = entry_of(s, s.scratch->rows[numbers[0]].member);
  const std::span<const CouplingRow*> first =
      all.arena.make<const CouplingRow*>(std::size_t(entry.body.particles.count));
  for (const CouplingRow*& one : first) one = nullptr;
  bool squeezed = false;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const SoftRow& row = s.scratch->rows[numbers[i]];
    if (row.body_compliance != Sym3{} || !row.is_contact()) continue;
    for_each_vertex(row, [&](std::uint32_t v, float) {
      if (first[v] == nullptr) first[v] = &rows[i];
      squeezed = squeezed || (dot(first[v]->normal, rows[i].normal) < kOpposite &&
                              (first[v]->is_missed || rows[i].is_missed));
    });
  }
  return squeezed;
}

// By vertex: 0 for those of a stiff piece that bears nothing but itself: no rigid body that yields and no other soft matter.
std::span<const std::uint8_t> find_loaded(SoftSolve& s, std::span<const std::uint32_t> numbers,
                                          std::span<const CouplingRow> rows) {
  SoftSurfaces& all = s.scratch->surfaces;
  const std::size_t count = all.positions.size();
  const std::span<std::uint8_t> piece = all.arena.make<std::uint8_t>(count),
                                loaded = all.arena.make<std::uint8_t>(count);
  for (std::uint8_t& one : piece) one = 0;
  const auto load = [&](const CouplingRow& row) {
    for (const std::uint32_t v : row.vertex)
      if (all.stiff[v] != kNoStiffPiece) piece[all.stiff[v]] = 1;
  };
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (s.scratch->rows[numbers[i]].body_compliance != Sym3{}) load(rows[i]);
  for (const CouplingRow& row : all.contacts.rows.view().first(all.contacts.row_pairs.size()))
    if (row.impulse != Vec3{}) load(row);
  for (std::size_t v = 0; v < count; ++v) loaded[v] = all.stiff[v] == kNoStiffPiece ? 1 : piece[all.stiff[v]];
  return loaded;
}

// Impulses of contacts with what does not yield are not remembered by members that are squeezed, or of which one closes more than it may: they would grow without bound and throw what comes
// free, and one that stays alone would throw it at once. Nor are those of stiff solids that bear nothing but themselves: where two sides hold one, impulses that
// were in balance are not when it has turned. Nor are those of visual members, whose velocities come from places that were moved to fit.
void forget_squeezes(SoftSolve& s, std::span<const std::uint32_t> numbers,
                     std::span<const CouplingRow> rows) {
  const auto yields = [](const SoftRow& row) { return row.body_compliance != Sym3{}; };
  const std::span<const std::uint8_t> loaded = find_loaded(s, numbers, rows);
  for (std::size_t begin = 0, end = 0; begin < numbers.size(); begin = end) {
    const std::uint32_t member = s.scratch->rows[numbers[begin]].member;
    bool forgets = !s.scratch->rows[numbers[begin]].pushes;
    for (; end < numbers.size() && s.scratch->rows[numbers[end]].member == member; ++end)
      forgets =
          forgets || (rows[end].is_closing && !rows[end].holds && !yields(s.scratch->rows[numbers[end]]));
    forgets = forgets || !loaded[rows[begin].vertex[0]] ||
              is_squeezed(s, numbers.subspan(begin, end - begin), rows.subspan(begin, end - begin));
    for (std::size_t i = begin; i < end && forgets; ++i) {
      SoftRow& row = s.scratch->rows[numbers[i]];
      if (row.is_contact() && (!row.pushes || !yields(row))) row.impulse = {};
    }
  }
}

// Gives the bodies what the rows gained, and tells how contacts hold.
void take_shape_rows(SoftSolve& s, std::span<const std::uint32_t> numbers,
                     std::span<const CouplingRow> rows) {
  clear_changes(s);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    SoftRow& row = s.scratch->rows[numbers[i]];
    try_on_body(s, row, rows[i].impulse - row.impulse);
    row.impulse = rows[i].impulse;
    if (row.grip == SoftGrip::emerges || !row.is_contact()) continue;
    const bool pushes = dot(row.normal, row.impulse) > 0.0f;
    row.grip = !pushes ? SoftGrip::open : rows[i].slides ? SoftGrip::slides : SoftGrip::sticks;
  }
  change_bodies(s, 1.0f);
  forget_squeezes(s, numbers, rows);
}

// Solves all contacts, and gives members what they get.
void solve_contacts(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  const ArenaScope scope(all.arena);
  const std::span<CoupledBody> bodies = all.arena.make<CoupledBody>(all.placed.size() + all.others.size());
  std::size_t count = 0;
  for_each_member(all, [&](std::uint32_t member, std::uint32_t first) {
    const SoftStep& step = work_at(s, member).step;
    bodies[count++] = {&entry_at(s, member).body,
                       step.method == SoftMethod::conjugate_gradients ? &step.implicit : nullptr,
                       step.carried, first};
  });
  const std::span<Vec3> change = all.arena.make<Vec3>(all.velocities.size());
  all.contacts.rows.clear(), all.contacts.row_pairs.clear();
  if (all.active) make_coupling_rows(vertices_of(all), settings_of(s), all.contacts);
  const std::size_t of_surfaces = all.contacts.rows.size();
  const std::span<const std::uint32_t> numbers = add_shape_rows(s);
  const std::span<CouplingRow> rows = all.contacts.rows;
  CoupledSettings settings;
  settings.rest_speed = kRestShare * s.h * reference_gravity(s.w->settings);
  const CoupledReport report =
      solve_coupled(bodies, gather_rigid(s), rows, {all.blocks, all.velocities, all.contacts.owed, change},
                    settings, *s.kernels, all.arena, *s.tasks);
  all.unmet = all.unmet || !report.met;
  take_impulses(all.inverse_mass, all.contacts);
  take_shape_rows(s, numbers, rows.subspan(of_surfaces));
  for (SoftRow& row : s.scratch->rows) row.carried_step = {};
  for_each_member(all, [&](std::uint32_t member, std::uint32_t first) {
    SoftEntry& entry = entry_at(s, member);
    SoftWork& work = work_at(s, member);
    for (int i = 0; i < entry.body.particles.count; ++i) work.change[i] = change[first + std::uint32_t(i)];
    add_change(entry, work.step, work.change.view(), 1.0f);
    add_carried_change(s, member);
  });
  give_to_bodies(s);
}

// Puts the vertices of a member where the bounds let them. Velocities follow what the bounds took, or they would go on stretching the body; of a
// body that nothing holds the linear and angular momentum stay. Explicit schemes keep their velocities: what they gain is their lesson.
void place_vertices(SoftSolve& s, std::uint32_t member, std::uint32_t first) {
  SoftSurfaces& all = s.scratch->surfaces;
  SoftBody& body = entry_at(s, member).body;
  Particles& p = body.particles;
  const double rate = 1.0 / double(s.h);
  const VectorRows change = make_vectors(all.arena, p.x.size()), none = make_vectors(all.arena, p.x.size());
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    change.x[i] = change.y[i] = change.z[i] = none.x[i] = none.y[i] = none.z[i] = 0.0f;
  }
  bool any = false;
  ByPiece<DVec3> moments(body.pieces());  // of the displacements, at the velocities of the vertices
  for (int i = 0; i < p.count; ++i) {
    const std::uint32_t v = first + std::uint32_t(i);
    p.set_place(i, all.positions[v]);
    if (p.loose[i] == 0.0f) continue;
    const DVec3 moved = all.positions[v] - all.targets[v], held_back = moved - DVec3(all.contacts.pushes[v]);
    if (moved == DVec3{}) continue;
    any = true;
    moments[body.piece_of(i)] += double(p.mass[i]) * cross(DVec3(p.velocity(i)), moved);
    change.x[i] = float(rate * held_back.x), change.y[i] = float(rate * held_back.y),
    change.z[i] = float(rate * held_back.z);
  }
  const SoftIntegrator scheme = entry_at(s, member).settings().integrator;
  if (!any || (scheme != SoftIntegrator::implicit && scheme != SoftIntegrator::sdirk2)) return;
  if (body.held.empty()) keep_momentum(body, none, change, 0.0, moments);
  for (int i = 0; i < p.count; ++i) {
    if (p.loose[i] != 0.0f) p.set_velocity(i, p.velocity(i) + Vec3{change.x[i], change.y[i], change.z[i]});
  }
}

// Finds where surfaces cross, if they may, and tells their bodies.
void find_crossings(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  SurfaceTangle& tangle = all.contacts.tangle;
  if (!all.may_cross) return;
  find_tangle(all.placed, all.positions, all.arena, tangle);
  for_each_surface(all, [&](std::uint32_t member, std::uint32_t) { entry_at(s, member).crossings = {}; });
  const auto crossings_of = [&](std::uint32_t placed) -> SoftCrossings& {
    return entry_at(s, all.member[placed]).crossings;
  };
  for (const EdgeCrossing& one : tangle.crossings) {
    ++crossings_of(one.edge_surface).count;
    if (one.triangle_surface != one.edge_surface) ++crossings_of(one.triangle_surface).count;
  }
  for (const TangledEdge& one : tangle.edges) {
    bool moves = false;
    for (const std::uint32_t v : one.vertex) moves = moves || all.inverse_mass[v] > 0.0f;
    if (!moves) continue;
    for (const std::uint32_t v : {one.vertex[0], one.vertex[2]}) crossings_of(tangle.surface[v]).moves = true;
  }
}

// Finds the members whose surfaces may touch others in the step, or pieces of their own.
void find_near(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  all.arena.reset();
  const float seconds = s.h * float(s.w->settings.substeps);
  const std::span<const std::uint32_t> group =
      group_soft(*s.store, length(s.w->settings.gravity), seconds, all.arena);
  const std::span<std::uint32_t> sizes = all.arena.make<std::uint32_t>(group.size());
  for (std::uint32_t& size : sizes) size = 0;
  for (const std::uint32_t one : group) ++sizes[one];
  all.near.assign(s.members.size(), std::uint8_t(0));
  for (std::size_t m = 0; m < s.members.size(); ++m) {
    const bool is_broken = entry_at(s, std::uint32_t(m)).body.pieces() > 1;
    all.near[m] = is_broken || sizes[group[s.members[m]]] > 1;
  }
}

// Lists the members without a surface that touch shapes, whose vertices stand behind those of surfaces. Returns the number of all vertices.
std::size_t list_others(SoftSolve& s, std::size_t vertices) {
  SoftSurfaces& all = s.scratch->surfaces;
  all.others.clear(), all.other_first.clear();
  all.has_contacts = false;
  for (std::uint32_t m = 0; m < std::uint32_t(s.members.size()); ++m) {
    const SoftWork& work = work_at(s, m);
    bool touches = false;
    for (std::uint32_t k = work.first_row; k < work.last_row; ++k)
      touches = touches || s.scratch->rows[k].coupled;
    all.has_contacts = all.has_contacts || touches;
    if (!touches || all.placed_of[m] >= 0) continue;
    all.others.push_back(m), all.other_first.push_back(std::uint32_t(vertices));
    vertices += std::size_t(entry_at(s, m).body.particles.count);
  }
  return vertices;
}

}  // namespace

void begin_soft_surfaces(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  const std::vector<std::shared_ptr<const SoftSurface>> before = std::move(all.surfaces);
  all.surfaces.clear(), all.placed.clear(), all.member.clear();
  all.placed_of.assign(s.members.size(), -1);
  std::size_t vertices = 0;
  bool any_self = false;
  for (std::uint32_t m = 0; m < std::uint32_t(s.members.size()); ++m) {
    const SoftEntry& entry = entry_at(s, m);
    if (entry.contact_surface == nullptr || !entry.contact_surface->touches_soft) continue;
    all.placed_of[m] = std::int32_t(all.placed.size());
    all.placed.push_back({entry.contact_surface.get(), std::uint32_t(vertices)});
    all.surfaces.push_back(entry.contact_surface);
    all.member.push_back(m);
    any_self |= entry.contact_surface->self_collision;
    vertices += std::size_t(entry.contact_surface->vertices);
  }
  all.active = any_self || all.placed.size() > 1;
  all.unmet = false;
  if (all.surfaces != before) {
    all.contacts.search.candidates.surfaces.clear();
    all.may_cross = true;
  }
  for (const std::uint32_t slot : s.members) s.store->entries[slot].crossings = {};
  find_near(s);
  const std::size_t with_others = list_others(s, vertices);
  all.positions.resize(vertices), all.targets.resize(vertices);
  all.velocities.resize(with_others), all.inverse_mass.resize(with_others), all.blocks.resize(with_others),
      all.stiff.resize(with_others);
  all.contacts.clear(with_others);
  if (!all.active) return all.left.clear();
  for_each_surface(all, [&](std::uint32_t member, std::uint32_t first) {
    const Particles& p = entry_at(s, member).body.particles;
    for (int i = 0; i < p.count; ++i) all.positions[first + std::uint32_t(i)] = p.place(i);
  });
  all.may_cross = all.may_cross || all.left.size() != vertices;
  for (std::size_t v = 0; v < vertices && !all.may_cross; ++v)
    all.may_cross = !(all.left[v] == all.positions[v]);
  all.left.clear();
}

void add_forces_of_surfaces(SoftSolve& s, std::uint32_t member) {
  SoftSurfaces& all = s.scratch->surfaces;
  if (!all.active || all.placed_of[member] < 0) return;
  const std::uint32_t first = all.placed[all.placed_of[member]].first;
  Particles& p = entry_at(s, member).body.particles;
  const float rate = 1.0f / s.h;
  for (int i = 0; i < p.count; ++i) {
    const Vec3 force = rate * all.contacts.totals[first + std::uint32_t(i)];
    p.fx[i] += force.x, p.fy[i] += force.y, p.fz[i] += force.z;
  }
}

long count_soft_crossings(const SoftStore& store, Arena& arena) {
  Array<PlacedSurface> placed;
  Array<DVec3> positions;
  store.for_each([&](const SoftEntry& entry) {
    if (entry.contact_surface == nullptr || !entry.contact_surface->touches_soft) return;
    placed.push_back({entry.contact_surface.get(), std::uint32_t(positions.size())});
    for (int i = 0; i < entry.body.particles.count; ++i) positions.push_back(entry.body.particles.place(i));
  });
  return count_crossings(placed, positions, arena);
}

void solve_soft_contacts(SoftSolve& s, int, int) {
  give_to_bodies(s);
  SoftSurfaces& all = s.scratch->surfaces;
  if (!all.active && !all.has_contacts) return;
  all.arena.reset();
  gather_velocities(s);
  find_responses(s);
  if (all.active) {
    find_crossings(s);
    find_surface_contacts(all.placed, vertices_of(all), settings_of(s), all.arena, *s.tasks, all.contacts);
  }
  solve_contacts(s);
  if (all.active) push_surfaces(vertices_of(all), settings_of(s), all.arena, all.contacts);
}

void end_soft_surfaces(SoftSolve& s) {
  SoftSurfaces& all = s.scratch->surfaces;
  if (all.active) all.left.assign(all.positions);
}

void bound_soft_surfaces(SoftSolve& s, int, int) {
  SoftSurfaces& all = s.scratch->surfaces;
  if (!all.active) return;
  all.arena.reset();
  for_each_surface(all, [&](std::uint32_t member, std::uint32_t first) {
    const Particles& p = entry_at(s, member).body.particles;
    for (int i = 0; i < p.count; ++i) all.targets[first + std::uint32_t(i)] = p.place(i);
  });
  all.report = move_surfaces(all.placed, vertices_of(all), all.targets, settings_of(s), all.arena, *s.tasks,
                             all.contacts);
  for_each_surface(all, [&](std::uint32_t member, std::uint32_t first) { place_vertices(s, member, first); });
  // Far away, rounding may carry features through each other.
  all.may_cross = !all.contacts.tangle.empty() || all.report.forced > 0 || all.report.crossed > 0 ||
                  all.contacts.search.candidates.is_far;
  if (all.unmet) all.contacts.clear(all.velocities.size());
  all.unmet = false;
}

}  // namespace gyre
