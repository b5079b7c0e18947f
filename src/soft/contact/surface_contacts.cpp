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
// Edges that cross resist by so many times what their bare masses do.
constexpr float kUntangleResistance = 2.0f;

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

// Takes out pairs within a stiff piece: planes between its features would stop it from turning.
void leave_out_stiff(std::span<const std::uint32_t> stiff, Array<SurfacePair>& pairs) {
  if (stiff.empty()) return;
  std::size_t kept = 0;
  for (const SurfacePair& pair : pairs) {
    const std::uint32_t a = stiff[pair.vertex[0]], b = stiff[pair.vertex[pair.on_a]];
    if (a != b || a == kNoStiffPiece) pairs[kept++] = pair;
  }
  pairs.resize(kept);
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

// One pair to be pushed apart, with all that a sweep reads.
struct Row {
  std::uint32_t vertex[4];
  float weight[4];
  float change[4];  // 1/kg: weight times inverse mass
  Vec3 normal;
  float mass;    // kg
  float target;  // m: least displacement along the normal
  float push;    // kg m
};

Vec3 sum_of(std::span<const Vec3> values, const std::uint32_t (&vertex)[4], const float (&weight)[4]) {
  return weight[0] * values[vertex[0]] + weight[1] * values[vertex[1]] + weight[2] * values[vertex[2]] +
         weight[3] * values[vertex[3]];
}
void add_to(std::span<Vec3> values, const Row& row, Vec3 impulse) {
  for (int k = 0; k < 4; ++k) values[row.vertex[k]] += row.change[k] * impulse;
}
// Pairs that do not touch close no further than bounds let them: their rows tell the solve, which would else stretch what bounds hold back.
float gap_of(const SurfacePair& pair, const BoundSettings& bounds) {
  return float(pair.distance - (pair.touches ? 1.0 : bounds.least_gap) * double(pair.thickness));
}

Row make_row(const SurfacePair& pair, const SurfaceVertices& vertices) {
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
  row.push = 0.0f;
  return row;
}

bool may_touch(const SurfacePair& pair, const SurfaceVertices& vertices,
               const SurfaceContactSettings& settings) {
  const float gap = gap_of(pair, settings.bounds), near = kNearOfThickness * pair.thickness;
  if (gap < near) return true;
  if (!pair.touches) return false;
  const Vec3 velocity = sum_of(vertices.velocities, pair.vertex, pair.weight);
  return gap - near < -kMoveAhead * settings.step * dot(to_float(pair.normal), velocity);
}

void solve_push(Row& row, std::span<Vec3> pushes) {
  const float now = dot(row.normal, sum_of(pushes, row.vertex, row.weight));
  const float push = max(0.0f, row.push + (row.target - now) * row.mass);
  add_to(pushes, row, (push - row.push) * row.normal);
  row.push = push;
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
  leave_out_stiff(vertices.stiff, contacts.pairs);
  keep_impulses(before, impulses, contacts.pairs, contacts.impulses);
  sum_impulses(vertices, contacts);
}

void make_coupling_rows(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                        SurfaceContacts& contacts) {
  contacts.rows.clear(), contacts.row_pairs.clear();
  for (std::uint32_t i = 0; i < std::uint32_t(contacts.pairs.size()); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    if (pair.normal == DVec3{}) continue;
    if (!(contacts.impulses[i].normal > 0.0f) && !may_touch(pair, vertices, settings)) continue;
    CouplingRow row;
    for (int k = 0; k < 4; ++k) row.vertex[k] = pair.vertex[k], row.weight[k] = pair.weight[k];
    row.vertex[4] = pair.vertex[0];
    row.normal = to_float(pair.normal);
    const SurfaceImpulse& impulse = contacts.impulses[i];
    row.impulse = impulse.normal * row.normal + impulse.friction;
    row.friction[0] = pair.friction[0], row.friction[1] = pair.friction[1];
    row.target = -max(gap_of(pair, settings.bounds), 0.0f) / settings.step;
    row.allowed = settings.closing * pair.thickness / settings.step;
    contacts.rows.push_back(row), contacts.row_pairs.push_back(i);
  }
  // Edges that cross may ask for opposite motions, so they resist by their bare masses, and their impulses do not add up over stages.
  for (const TangledEdge& edge : contacts.tangle.edges) {
    CouplingRow row;
    float mobility = 0.0f;
    for (int k = 0; k < 5; ++k) {
      row.vertex[k] = edge.vertex[k], row.weight[k] = edge.weight[k];
      mobility += edge.weight[k] * edge.weight[k] * vertices.inverse_mass[edge.vertex[k]];
    }
    if (!(mobility > 0.0f)) continue;
    row.normal = edge.way;
    row.damper = kUntangleResistance / mobility;
    row.target = edge.share * kUntangleShare * std::sqrt(settings.gravity * edge.edge);
    contacts.rows.push_back(row);
  }
}

void take_impulses(std::span<const float> inverse_mass, SurfaceContacts& contacts) {
  for (Vec3& owed : contacts.owed) owed = {};
  contacts.touching = 0;
  for (std::size_t r = 0; r < contacts.row_pairs.size(); ++r) {
    const CouplingRow& row = contacts.rows[r];
    SurfaceImpulse& impulse = contacts.impulses[contacts.row_pairs[r]];
    const Vec3 change = row.impulse - (impulse.normal * row.normal + impulse.friction);
    for (int k = 0; k < 4; ++k)
      if (inverse_mass[row.vertex[k]] > 0.0f) contacts.totals[row.vertex[k]] += row.weight[k] * change;
    impulse.normal = dot(row.normal, row.impulse);
    impulse.friction = row.impulse - impulse.normal * row.normal;
    contacts.touching += impulse.normal > 0.0f;
  }
}

void push_surfaces(const SurfaceVertices& vertices, const SurfaceContactSettings& settings, Arena& arena,
                   SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  contacts.pushes.assign(vertices.positions.size(), Vec3{});
  std::span<Row> rows = arena.make<Row>(contacts.pairs.size());
  std::size_t used = 0;
  for (std::uint32_t i = 0; i < std::uint32_t(contacts.pairs.size()); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    const float overlap = -gap_of(pair, settings.bounds);
    if (!pair.touches || overlap < kSlopOfThickness * pair.thickness) continue;
    Row& row = rows[used++];
    row = make_row(pair, vertices);
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
                         held, vertices.stiff, settings.bounds, moves, arena, tasks);
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
    leave_out_stiff(vertices.stiff, found);
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
