#include "soft/contact/surface_contacts.h"

#include <cmath>

namespace gyre {

namespace {

// Vertices are looked for a little beyond their plans, so that impulses and bounds may change their moves.
constexpr float kLimitOfMove = 0.2f;
constexpr float kLimitOfRadius = 0.1f;
constexpr float kLimitOfChange = 1.25f;  // where they ended farther from the plan
constexpr float kMoveAhead = 1.25f;      // rows of what approaches
constexpr double kMaxMoveOfEdge = 4.0;
constexpr double kRounding = 1.0 + 0x1p-20;
constexpr float kNearOfThickness = 0.1f;   // pairs nearer than this have rows whatever their velocity
constexpr float kSlopOfThickness = 0.01f;  // overlap that stays
constexpr float kMaxPushOfThickness = 0.25f;
// The speed with which crossed surfaces part, as a share of the speed of a fall from the length of an edge: as for vertices in shapes. It bounds the energy
// that untangling gives: half the mass times its square.
constexpr float kUntangleShare = 0.4f;
// An extension of impulses by less than this share of their change is not worth its solve.
constexpr float kMinExtension = 0.1f;
constexpr float kNoLimit = 1.0e30f;  // more than any extension

// Takes the mean from the moves: surfaces that fly together do not look far. Returns it.
DVec3 take_mean(std::span<const PlacedSurface> surfaces, std::span<DVec3> moves) {
  DVec3 sum{};
  double count = 0.0;
  for (const PlacedSurface& placed : surfaces) {
    for (int v = 0; v < placed.surface->vertices; ++v) sum += moves[placed.first + std::size_t(v)];
    count += double(placed.surface->vertices);
  }
  const DVec3 mean = count > 0.0 ? sum / count : DVec3{};
  for (DVec3& move : moves) move = move - mean;
  return mean;
}

// Shortens the moves that are longer than pairs are looked for.
void cut_moves(std::span<const PlacedSurface> surfaces, std::span<const float> inverse_mass,
               std::span<DVec3> moves) {
  for (const PlacedSurface& placed : surfaces) {
    for (int i = 0; i < placed.surface->vertices; ++i) {
      const std::size_t v = placed.first + std::size_t(i);
      const double most = kMaxMoveOfEdge * double(max(placed.surface->mean_edge, placed.surface->radius[i]));
      const double far = length(moves[v]);
      if (inverse_mass[v] > 0.0f && far > most) moves[v] = (most / far) * moves[v];
    }
  }
}

// Limits about this plan.
void set_limits(std::span<const PlacedSurface> surfaces, std::span<const float> inverse_mass,
                std::span<const DVec3> plan, std::span<float> limits) {
  for (const PlacedSurface& placed : surfaces) {
    for (int i = 0; i < placed.surface->vertices; ++i) {
      const std::size_t v = placed.first + std::size_t(i);
      limits[v] = inverse_mass[v] > 0.0f
                      ? kLimitOfMove * float(length(plan[v])) + kLimitOfRadius * placed.surface->radius[i]
                      : 0.0f;
    }
  }
}

// True if all moves end within the limits about the plan. Else the moves become the plan, and limits grow where they were too low.
bool keeps_plan(std::span<const PlacedSurface> surfaces, std::span<const float> inverse_mass,
                std::span<const DVec3> moves, SurfaceContacts& contacts, Arena& arena) {
  const ArenaScope scope(arena);
  const std::span<float> limits = arena.make<float>(moves.size());
  set_limits(surfaces, inverse_mass, moves, limits);
  bool keeps = true;
  for (std::size_t v = 0; v < moves.size(); ++v) {
    const double far = kRounding * length(moves[v] - contacts.plan[v]);
    if (far <= double(contacts.limits[v])) continue;
    keeps = false;
    // A vertex that ends elsewhere a second time may go to and fro; it is then looked for at both places.
    if (inverse_mass[v] > 0.0f && contacts.rounds > 1)
      limits[v] = max(limits[v], kLimitOfChange * float(far));
  }
  if (keeps) return true;
  for (std::size_t v = 0; v < moves.size(); ++v) {
    contacts.plan[v] = moves[v];
    contacts.limits[v] = limits[v];
  }
  return false;
}

// Impulses of the pairs that were there before; both lists have ascending keys.
void keep_impulses(std::span<const SurfacePair> before, std::span<const SurfaceImpulse> impulses,
                   std::span<const SurfacePair> now, Array<SurfaceImpulse>& out) {
  out.assign(now.size(), SurfaceImpulse{});
  std::size_t k = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    while (k < before.size() && before[k].key < now[i].key) ++k;
    if (k < before.size() && before[k].key == now[i].key) out[i] = impulses[k];
  }
}

// Sums the impulses of all pairs by vertex; the change is owed.
void sum_impulses(const SurfaceVertices& vertices, SurfaceContacts& contacts) {
  for (std::size_t v = 0; v < contacts.totals.size(); ++v) {
    contacts.owed[v] = -contacts.totals[v];
    contacts.totals[v] = {};
  }
  for (std::size_t i = 0; i < contacts.pairs.size(); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    SurfaceImpulse& impulse = contacts.impulses[i];
    if (!pair.touches) impulse = {};
    if (impulse.normal == 0.0f) continue;
    // The plane of friction turns with the normal.
    const Vec3 normal = to_float(pair.normal);
    impulse.friction -= dot(impulse.friction, normal) * normal;
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t v = pair.vertex[k];
      if (vertices.inverse_mass[v] > 0.0f)
        contacts.totals[v] += pair.weight[k] * (impulse.normal * normal + impulse.friction);
    }
  }
  for (std::size_t v = 0; v < contacts.totals.size(); ++v) contacts.owed[v] += contacts.totals[v];
}

// One contact, with all that a sweep reads.
struct Row {
  std::uint32_t vertex[4];
  float weight[4];
  float change[4];  // 1/kg: weight times inverse mass
  Vec3 normal;
  float mass;    // kg: impulse for a change of the relative velocity
  float target;  // m/s: least normal velocity
  float static_friction, dynamic_friction;
  SurfaceImpulse impulse;
  std::uint32_t pair;
};

Vec3 sum_of(std::span<const Vec3> values, const std::uint32_t (&vertex)[4], const float (&weight)[4]) {
  return weight[0] * values[vertex[0]] + weight[1] * values[vertex[1]] + weight[2] * values[vertex[2]] +
         weight[3] * values[vertex[3]];
}
void add_to(std::span<Vec3> values, const Row& row, Vec3 impulse) {
  for (int k = 0; k < 4; ++k) values[row.vertex[k]] += row.change[k] * impulse;
}
float gap_of(const SurfacePair& pair) { return float(pair.distance - double(pair.thickness)); }

Row make_row(const SurfacePair& pair, std::uint32_t number, const SurfaceVertices& vertices,
             const SurfaceImpulse& impulse) {
  Row row;
  float mobility = 0.0f;
  for (int k = 0; k < 4; ++k) {
    row.vertex[k] = pair.vertex[k];
    row.weight[k] = pair.weight[k];
    row.change[k] = pair.weight[k] * vertices.inverse_mass[pair.vertex[k]];
    mobility += row.weight[k] * row.change[k];
  }
  row.normal = to_float(pair.normal);
  row.mass = mobility > 0.0f ? 1.0f / mobility : 0.0f;
  row.target = 0.0f;
  row.static_friction = pair.friction[0], row.dynamic_friction = pair.friction[1];
  row.impulse = impulse;
  row.pair = number;
  return row;
}

bool may_touch(const SurfacePair& pair, const SurfaceVertices& vertices, float step) {
  const float gap = gap_of(pair), near = kNearOfThickness * pair.thickness;
  if (gap < near) return true;
  const Vec3 velocity = sum_of(vertices.velocities, pair.vertex, pair.weight);
  return gap - near < -kMoveAhead * step * dot(to_float(pair.normal), velocity);
}

void solve_row(Row& row, std::span<Vec3> velocities) {
  const Vec3 velocity = sum_of(velocities, row.vertex, row.weight);
  const float along = dot(row.normal, velocity);
  const float normal = max(0.0f, row.impulse.normal - (along - row.target) * row.mass);
  if (normal == 0.0f && row.impulse.normal == 0.0f) return;
  // Inverse masses are scalars: normal and friction do not act on each other within a row.
  Vec3 friction = row.impulse.friction - row.mass * (velocity - along * row.normal);
  const float size = length(friction);
  if (size > row.static_friction * normal) friction = (row.dynamic_friction * normal / size) * friction;
  add_to(velocities, row, (normal - row.impulse.normal) * row.normal + (friction - row.impulse.friction));
  row.impulse = {normal, friction};
}

// An edge that passes through a triangle moves along its way out, at a given speed or faster.
struct TangleRow {
  const TangledEdge* edge;
  float change[5];  // 1/kg: weight times inverse mass
  float mass;       // kg
  float target;     // m/s: least speed along the way
  float impulse;
};

std::span<TangleRow> make_tangle_rows(const SurfaceTangle& tangle, const SurfaceVertices& vertices,
                                      Arena& arena) {
  const std::span<TangleRow> rows = arena.make<TangleRow>(tangle.edges.size());
  std::size_t used = 0;
  for (const TangledEdge& edge : tangle.edges) {
    TangleRow& row = rows[used];
    float mobility = 0.0f;
    for (int k = 0; k < 5; ++k) {
      row.change[k] = edge.weight[k] * vertices.inverse_mass[edge.vertex[k]];
      mobility += edge.weight[k] * row.change[k];
    }
    if (!(mobility > 0.0f)) continue;
    row.edge = &edge, row.mass = 1.0f / mobility, row.target = row.impulse = 0.0f;
    ++used;
  }
  return rows.first(used);
}

void solve_tangle_row(TangleRow& row, std::span<Vec3> velocities) {
  const TangledEdge& edge = *row.edge;
  Vec3 relative{};
  for (int k = 0; k < 5; ++k) relative += edge.weight[k] * velocities[edge.vertex[k]];
  const float impulse = max(0.0f, row.impulse + (row.target - dot(edge.way, relative)) * row.mass);
  if (impulse == row.impulse) return;
  const Vec3 change = (impulse - row.impulse) * edge.way;
  for (int k = 0; k < 5; ++k) velocities[edge.vertex[k]] += row.change[k] * change;
  row.impulse = impulse;
}

void solve_push(Row& row, std::span<Vec3> pushes) {
  const float now = dot(row.normal, sum_of(pushes, row.vertex, row.weight));
  const float push = max(0.0f, row.impulse.normal + (row.target - now) * row.mass);
  add_to(pushes, row, (push - row.impulse.normal) * row.normal);
  row.impulse.normal = push;
}

}  // namespace

void find_surface_contacts(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                           const SurfaceContactSettings& settings, Arena& arena, TaskSystem& tasks,
                           SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  const std::size_t count = vertices.positions.size();
  contacts.plan.resize(count), contacts.limits.resize(count);
  for (std::size_t v = 0; v < count; ++v)
    contacts.plan[v] = double(settings.step) * DVec3(vertices.velocities[v]);
  take_mean(surfaces, contacts.plan);
  cut_moves(surfaces, vertices.inverse_mass, contacts.plan);
  set_limits(surfaces, vertices.inverse_mass, contacts.plan, contacts.limits);
  const std::span<SurfacePair> before = arena.make<SurfacePair>(contacts.pairs.size());
  const std::span<SurfaceImpulse> impulses = arena.make<SurfaceImpulse>(contacts.impulses.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    before[i] = contacts.pairs[i];
    impulses[i] = contacts.impulses[i];
  }
  find_surface_pairs(surfaces, vertices.positions, contacts.plan, contacts.limits,
                     float(settings.bounds.least_gap), arena, tasks, contacts.search, contacts.pairs);
  leave_out(contacts.tangle, contacts.pairs);
  keep_impulses(before, impulses, contacts.pairs, contacts.impulses);
  sum_impulses(vertices, contacts);
}

void solve_surface_contacts(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                            Arena& arena, SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  const std::size_t count = vertices.positions.size();
  const std::span<Vec3> velocities = arena.make<Vec3>(count), start = arena.make<Vec3>(count);
  for (std::size_t v = 0; v < count; ++v)
    velocities[v] = start[v] = vertices.velocities[v] + vertices.inverse_mass[v] * contacts.owed[v];
  std::span<Row> rows = arena.make<Row>(contacts.pairs.size());
  std::size_t used = 0;
  for (std::uint32_t i = 0; i < std::uint32_t(contacts.pairs.size()); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    if (!pair.touches) continue;
    if (!(contacts.impulses[i].normal > 0.0f) && !may_touch(pair, vertices, settings.step)) continue;
    Row& row = rows[used++];
    row = make_row(pair, i, vertices, contacts.impulses[i]);
    const float gap = gap_of(pair);
    if (gap > 0.0f) row.target = -gap / settings.step;
  }
  rows = rows.first(used);
  const std::span<TangleRow> tangled = make_tangle_rows(contacts.tangle, vertices, arena);
  for (TangleRow& row : tangled)
    row.target = row.edge->share * kUntangleShare * std::sqrt(settings.gravity * row.edge->edge);
  for (int n = 0; n < settings.iterations; ++n) {
    for (std::size_t i = 0; i < used; ++i) solve_row(rows[n % 2 == 0 ? i : used - 1 - i], velocities);
    for (TangleRow& row : tangled) solve_tangle_row(row, velocities);
  }
  contacts.touching = 0;
  for (const Row& row : rows) {
    contacts.impulses[row.pair] = row.impulse;
    contacts.touching += row.impulse.normal > 0.0f;
  }
  for (std::size_t v = 0; v < count; ++v) {
    const float w = vertices.inverse_mass[v];
    if (!(w > 0.0f)) continue;
    const Vec3 change = (velocities[v] - start[v]) / w;
    contacts.owed[v] += change;
    contacts.totals[v] += change;
  }
  // Impulses that untangle do not act again in the next sub-step: other edges cross then.
  for (const TangleRow& row : tangled) {
    for (int k = 0; k < 5; ++k) {
      const std::uint32_t v = row.edge->vertex[k];
      if (vertices.inverse_mass[v] > 0.0f)
        contacts.totals[v] += -(row.edge->weight[k] * row.impulse) * row.edge->way;
    }
  }
}

float worst_closing(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                    const SurfaceContacts& contacts) {
  float worst = 0.0f;
  for (const SurfacePair& pair : contacts.pairs) {
    if (!pair.touches) continue;
    const float along = dot(to_float(pair.normal), sum_of(vertices.velocities, pair.vertex, pair.weight));
    worst = max(worst, (-along * settings.step - max(gap_of(pair), 0.0f)) / pair.thickness);
  }
  return worst;
}

bool extend_impulses(std::span<const SurfaceImpulse> before, std::span<const Vec3> start,
                     const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                     SurfaceContacts& contacts) {
  double missing = 0.0, gained = 0.0;
  float most = kNoLimit;  // by which no normal impulse becomes negative
  for (std::size_t i = 0; i < contacts.pairs.size(); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    const float change = contacts.impulses[i].normal - before[i].normal;
    const Vec3 normal = to_float(pair.normal);
    const Vec3 way = change * normal + (contacts.impulses[i].friction - before[i].friction);
    if (way == Vec3{}) continue;
    const Vec3 now = sum_of(vertices.velocities, pair.vertex, pair.weight),
               was = sum_of(start, pair.vertex, pair.weight);
    const float gap = gap_of(pair);
    const Vec3 target = gap > 0.0f ? (-gap / settings.step) * normal : Vec3{};
    missing += double(dot(way, target - now));
    gained += double(dot(way, now - was));
    if (change < 0.0f) most = min(most, contacts.impulses[i].normal / -change);
  }
  if (!(missing > 0.0) || !(gained > 0.0)) return false;
  const float more = min(float(missing / gained), most);
  if (!(more > kMinExtension)) return false;
  for (std::size_t i = 0; i < contacts.pairs.size(); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    SurfaceImpulse& impulse = contacts.impulses[i];
    const float normal = more * (impulse.normal - before[i].normal);
    const Vec3 friction = more * (impulse.friction - before[i].friction);
    if (normal == 0.0f && friction == Vec3{}) continue;
    impulse.normal += normal, impulse.friction += friction;
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t v = pair.vertex[k];
      if (!(vertices.inverse_mass[v] > 0.0f)) continue;
      const Vec3 given = pair.weight[k] * (normal * to_float(pair.normal) + friction);
      contacts.totals[v] += given, contacts.owed[v] += given;
    }
  }
  return true;
}

void push_surfaces(const SurfaceVertices& vertices, const SurfaceContactSettings& settings, Arena& arena,
                   SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  contacts.pushes.assign(vertices.positions.size(), Vec3{});
  std::span<Row> rows = arena.make<Row>(contacts.pairs.size());
  std::size_t used = 0;
  for (std::uint32_t i = 0; i < std::uint32_t(contacts.pairs.size()); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    const float overlap = -gap_of(pair);
    if (!pair.touches || overlap < kSlopOfThickness * pair.thickness) continue;
    Row& row = rows[used++];
    row = make_row(pair, i, vertices, {});
    row.target = min(settings.pushout * overlap, kMaxPushOfThickness * pair.thickness);
  }
  for (int n = 0; n < settings.push_iterations; ++n) {
    for (Row& row : rows.first(used)) solve_push(row, contacts.pushes);
  }
}

BoundReport move_surfaces(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                          std::span<const DVec3> targets, const SurfaceContactSettings& settings,
                          Arena& arena, TaskSystem& tasks, SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  const std::size_t count = vertices.positions.size();
  const std::span<DVec3> goals = arena.make<DVec3>(count), whole = arena.make<DVec3>(count),
                         asked = arena.make<DVec3>(count), moves = arena.make<DVec3>(count);
  const std::span<std::uint8_t> held = arena.make<std::uint8_t>(count);
  for (std::size_t v = 0; v < count; ++v) {
    held[v] = !(vertices.inverse_mass[v] > 0.0f);
    goals[v] = held[v] != 0 ? targets[v] : targets[v] + contacts.pushes[v];
    whole[v] = goals[v] - vertices.positions[v];
  }
  const DVec3 mean = take_mean(surfaces, whole);
  for (std::size_t v = 0; v < count; ++v) asked[v] = whole[v];
  cut_moves(surfaces, vertices.inverse_mass, asked);
  BoundReport report;
  Array<SurfacePair> found;
  std::span<const SurfacePair> pairs = contacts.pairs;
  for (contacts.rounds = 1;; ++contacts.rounds) {
    const bool last = contacts.rounds > settings.most_rounds;
    for (std::size_t v = 0; v < count; ++v) moves[v] = asked[v];
    // The last round is for pairs that are found for any moves no longer than those that are asked for.
    report = bound_moves(pairs, vertices.positions, last ? contacts.limits.view() : std::span<const float>(),
                         held, settings.bounds, moves, arena, tasks);
    if (last || keeps_plan(surfaces, vertices.inverse_mass, moves, contacts, arena)) break;
    if (contacts.rounds == settings.most_rounds) {
      for (std::size_t v = 0; v < count; ++v) {
        contacts.plan[v] = {};
        contacts.limits[v] = float(kRounding * length(asked[v]));
      }
    }
    find_surface_pairs(surfaces, vertices.positions, contacts.plan, contacts.limits,
                       float(settings.bounds.least_gap), arena, tasks, contacts.search, found);
    leave_out(contacts.tangle, found);
    pairs = found;
  }
  contacts.search.candidates.advance();
  for (std::size_t v = 0; v < count; ++v) {
    // The mean is given back.
    const bool there = held[v] != 0 || moves[v] == whole[v];
    vertices.positions[v] = there ? goals[v] : vertices.positions[v] + (moves[v] + mean);
  }
  return report;
}

}  // namespace gyre
