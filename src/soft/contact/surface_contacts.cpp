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
// The edges that cross part by no more force than so many times the weight of their vertices. More would press stiff solids out of shape where the ways out of their edges differ.
constexpr float kUntangleWeights = 10.0f;

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

// Velocities, or displacements, in the sweeps: those of the vertices, and what their bodies add as a whole.
struct Motions {
  std::span<Vec3> own;
  std::span<RigidVelocity> bodies;
  std::span<const RigidResponse> responses;

  Motions(const SurfaceVertices& vertices, Arena& arena)
      : own(arena.make<Vec3>(vertices.positions.size())),
        bodies(arena.make<RigidVelocity>(vertices.bodies.size())),
        responses(vertices.bodies) {
    for (RigidVelocity& body : bodies) body = {};
  }
};

constexpr int kMaxPointVertices = 5;

// Two points of features A and B, each a mean of vertices.
struct TouchingPoints {
  int count = 0;
  std::uint32_t vertex[kMaxPointVertices];
  float weight[kMaxPointVertices];                       // positive on A, negative on B
  float change[kMaxPointVertices];                       // 1/kg: weight times the vertex's own response
  std::uint32_t body[2] = {kNoRigidBody, kNoRigidBody};  // of A and B
  Vec3 arm[2] = {};                                      // m, from their centres
  float own = 0.0f;                                      // 1/kg: the own response of all vertices together
  Sym3 whole{};                                          // 1/kg: that of the bodies as a whole

  Vec3 velocity(const Motions& motions) const {
    Vec3 sum{};
    for (int k = 0; k < count; ++k) sum += weight[k] * motions.own[vertex[k]];
    if (body[0] != kNoRigidBody) sum += motions.bodies[body[0]].at(arm[0]);
    if (body[1] != kNoRigidBody) sum -= motions.bodies[body[1]].at(arm[1]);
    return sum;
  }
  void push(const Motions& motions, Vec3 impulse) const {
    for (int k = 0; k < count; ++k) motions.own[vertex[k]] += change[k] * impulse;
    for (int side = 0; side < 2; ++side) {
      if (body[side] != kNoRigidBody)
        motions.bodies[body[side]] +=
            motions.responses[body[side]].of(side == 0 ? impulse : -impulse, arm[side]);
    }
  }
};

// `on_a`: how many of the vertices are A's.
TouchingPoints touching_points(const SurfaceVertices& vertices, std::span<const std::uint32_t> vertex,
                               std::span<const float> weight, int on_a) {
  TouchingPoints points;
  points.count = int(vertex.size());
  for (int k = 0; k < points.count; ++k) {
    const std::uint32_t v = vertex[std::size_t(k)];
    points.vertex[k] = v, points.weight[k] = weight[std::size_t(k)];
    points.change[k] = points.weight[k] * vertices.own(v);
    points.own += points.weight[k] * points.change[k];
  }
  if (vertices.bodies.empty()) return points;
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int side = 0; side < 2; ++side) {
    const int first = side == 0 ? 0 : on_a, last = side == 0 ? on_a : points.count;
    const std::uint32_t body = vertices.body_of[vertex[std::size_t(first)]];
    if (body == kNoRigidBody) continue;
    const RigidResponse& response = vertices.bodies[body];
    points.body[side] = body;
    for (int k = first; k < last; ++k)
      points.arm[side] +=
          absolute(points.weight[k]) * difference(vertices.positions[points.vertex[k]], response.center);
    const Vec3 arm = points.arm[side];
    const Vec3 x = response.of(axes[0], arm).at(arm), y = response.of(axes[1], arm).at(arm),
               z = response.of(axes[2], arm).at(arm);
    points.whole = points.whole + Sym3{x.x, y.y, z.z, x.y, x.z, y.z};
  }
  return points;
}

// One contact, with all that a sweep reads.
struct Row {
  TouchingPoints points;
  Vec3 normal;
  Vec3 turned;     // 1/kg: the change of the velocity by an impulse of 1 along the normal
  float stiff;     // 1/kg: its part along the normal
  float sideways;  // 1/kg: no less than any response across the normal
  float target;    // m/s: least normal velocity
  float static_friction, dynamic_friction;
  SurfaceImpulse impulse;
  std::uint32_t pair;
};

Vec3 sum_of(std::span<const Vec3> values, const std::uint32_t (&vertex)[4], const float (&weight)[4]) {
  return weight[0] * values[vertex[0]] + weight[1] * values[vertex[1]] + weight[2] * values[vertex[2]] +
         weight[3] * values[vertex[3]];
}
// True for vertices of one piece that is rigid within a sub-step. Such a piece does not meet itself, but planes between its features would stop it from turning.
bool is_within_stiff(const SurfacePair& pair, const SurfaceVertices& vertices) {
  if (vertices.bodies.empty()) return false;
  const std::uint32_t a = vertices.body_of[pair.vertex[0]], b = vertices.body_of[pair.vertex[pair.on_a]];
  return a == b && a != kNoRigidBody && vertices.bodies[a].is_stiff;
}
void leave_out_stiff(const SurfaceVertices& vertices, Array<SurfacePair>& pairs) {
  std::size_t kept = 0;
  for (const SurfacePair& pair : pairs)
    if (!is_within_stiff(pair, vertices)) pairs[kept++] = pair;
  pairs.resize(kept);
}

float gap_of(const SurfacePair& pair) { return float(pair.distance - double(pair.thickness)); }

Row make_row(const SurfacePair& pair, std::uint32_t number, const SurfaceVertices& vertices,
             const SurfaceImpulse& impulse) {
  Row row;
  row.points = touching_points(vertices, pair.vertex, pair.weight, pair.on_a);
  row.normal = to_float(pair.normal);
  row.turned = row.points.own * row.normal + row.points.whole * row.normal;
  row.stiff = dot(row.normal, row.turned);
  const Sym3& whole = row.points.whole;
  row.sideways = row.points.own + (whole.xx + whole.yy + whole.zz - dot(row.normal, whole * row.normal));
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

void solve_row(Row& row, const Motions& motions) {
  if (!(row.stiff > 0.0f)) return;
  const Vec3 velocity = row.points.velocity(motions);
  const float normal = max(0.0f, row.impulse.normal - (dot(row.normal, velocity) - row.target) / row.stiff);
  if (normal == 0.0f && row.impulse.normal == 0.0f) return;
  // The normal impulse turns the bodies, which slide by that.
  const Vec3 slide = velocity + (normal - row.impulse.normal) * row.turned;
  Vec3 friction =
      row.impulse.friction - (1.0f / row.sideways) * (slide - dot(row.normal, slide) * row.normal);
  const float size = length(friction);
  if (size > row.static_friction * normal) friction = (row.dynamic_friction * normal / size) * friction;
  row.points.push(motions, (normal - row.impulse.normal) * row.normal + (friction - row.impulse.friction));
  row.impulse = {normal, friction};
}

// An edge that passes through a triangle moves along its way out, at a given speed or faster.
struct TangleRow {
  TouchingPoints points;
  const TangledEdge* edge;
  float mass;    // kg
  float target;  // m/s: least speed along the way
  float most;    // N s
  float impulse;
};

std::span<TangleRow> make_tangle_rows(const SurfaceTangle& tangle, const SurfaceVertices& vertices,
                                      const SurfaceContactSettings& settings, Arena& arena) {
  const std::span<TangleRow> rows = arena.make<TangleRow>(tangle.edges.size());
  std::size_t used = 0;
  for (const TangledEdge& edge : tangle.edges) {
    TangleRow& row = rows[used];
    row.points = touching_points(vertices, edge.vertex, edge.weight, 2);
    const float stiff = row.points.own + dot(edge.way, row.points.whole * edge.way);
    if (!(stiff > 0.0f)) continue;
    float mobility = 0.0f;  // 1/kg, of the vertices alone
    for (int k = 0; k < 5; ++k)
      mobility += edge.weight[k] * edge.weight[k] * vertices.inverse_mass[edge.vertex[k]];
    row.edge = &edge, row.mass = 1.0f / stiff, row.target = row.impulse = 0.0f;
    row.most = kUntangleWeights * settings.step * settings.gravity / mobility;
    ++used;
  }
  return rows.first(used);
}

void solve_tangle_row(TangleRow& row, const Motions& motions) {
  const Vec3 way = row.edge->way;
  const float impulse = min(
      max(0.0f, row.impulse + (row.target - dot(way, row.points.velocity(motions))) * row.mass), row.most);
  if (impulse == row.impulse) return;
  row.points.push(motions, (impulse - row.impulse) * way);
  row.impulse = impulse;
}

void solve_push(Row& row, const Motions& pushes) {
  if (!(row.stiff > 0.0f)) return;
  const float now = dot(row.normal, row.points.velocity(pushes));
  const float push = max(0.0f, row.impulse.normal + (row.target - now) / row.stiff);
  row.points.push(pushes, (push - row.impulse.normal) * row.normal);
  row.impulse.normal = push;
}

// Adds a change of the impulse at two points to what vertices are owed. `totals`: and to their totals.
void owe(const TouchingPoints& points, Vec3 impulse, const SurfaceVertices& vertices, bool totals,
         SurfaceContacts& contacts) {
  for (int k = 0; k < points.count; ++k) {
    const std::uint32_t v = points.vertex[k];
    if (!(vertices.inverse_mass[v] > 0.0f)) continue;
    const Vec3 given = points.weight[k] * impulse;
    contacts.owed[v] += given;
    if (totals) contacts.totals[v] += given;
  }
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
  leave_out_stiff(vertices, contacts.pairs);
  keep_impulses(before, impulses, contacts.pairs, contacts.impulses);
  sum_impulses(vertices, contacts);
}

void solve_surface_contacts(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                            Arena& arena, SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  const Motions motions(vertices, arena);
  for (std::size_t v = 0; v < motions.own.size(); ++v) motions.own[v] = vertices.velocities[v];
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
  const std::span<TangleRow> tangled = make_tangle_rows(contacts.tangle, vertices, settings, arena);
  for (TangleRow& row : tangled)
    row.target = row.edge->share * kUntangleShare * std::sqrt(settings.gravity * row.edge->edge);
  for (int n = 0; n < settings.iterations; ++n) {
    for (std::size_t i = 0; i < used; ++i) solve_row(rows[n % 2 == 0 ? i : used - 1 - i], motions);
    for (TangleRow& row : tangled) solve_tangle_row(row, motions);
  }
  contacts.touching = 0;
  contacts.aimed = 0.0;
  for (const Row& row : rows) {
    SurfaceImpulse& before = contacts.impulses[row.pair];
    const float normal = row.impulse.normal - before.normal;
    owe(row.points, normal * row.normal + (row.impulse.friction - before.friction), vertices, true, contacts);
    contacts.aimed += double(normal) * double(row.target);
    before = row.impulse;
    contacts.touching += row.impulse.normal > 0.0f;
  }
  // Impulses that untangle do not act again in the next sub-step: other edges cross then.
  contacts.most_share = kAnyShare;
  for (const TangleRow& row : tangled) {
    if (row.impulse > 0.0f) contacts.most_share = min(contacts.most_share, row.most / row.impulse);
    owe(row.points, row.impulse * row.edge->way, vertices, false, contacts);
    contacts.aimed += double(row.impulse) * double(row.target);
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

float take_best_share(std::span<const SurfaceImpulse> before, const SurfaceVertices& vertices,
                      std::span<const Vec3> change, float most_share, SurfaceContacts& contacts) {
  double slope = contacts.aimed, curvature = 0.0;
  for (std::size_t v = 0; v < contacts.owed.size(); ++v) {
    slope -= double(dot(contacts.owed[v], vertices.velocities[v]));
    curvature += double(dot(contacts.owed[v], change[v]));
  }
  float most = min(most_share, contacts.most_share);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const float less = before[i].normal - contacts.impulses[i].normal;
    if (less > 0.0f) most = min(most, before[i].normal / less);
  }
  if (!(slope > 0.0) || !(curvature > 0.0)) most = 0.0f;
  const float share = most > 0.0f ? min(float(slope / curvature), most) : 0.0f;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    SurfaceImpulse& impulse = contacts.impulses[i];
    const float normal = impulse.normal - before[i].normal;
    const Vec3 friction = impulse.friction - before[i].friction;
    if (normal == 0.0f && friction == Vec3{}) continue;
    impulse.normal = before[i].normal + share * normal,
    impulse.friction = before[i].friction + share * friction;
    const Vec3 more = (share - 1.0f) * (normal * to_float(pair.normal) + friction);
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t v = pair.vertex[k];
      if (vertices.inverse_mass[v] > 0.0f) contacts.totals[v] += pair.weight[k] * more;
    }
  }
  for (Vec3& owed : contacts.owed) owed = {};
  return share;
}

void push_surfaces(const SurfaceVertices& vertices, const SurfaceContactSettings& settings, Arena& arena,
                   SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  contacts.pushes.assign(vertices.positions.size(), Vec3{});
  const Motions pushes(vertices, arena);
  for (Vec3& own : pushes.own) own = {};
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
  if (used == 0) return;
  for (int n = 0; n < settings.push_iterations; ++n) {
    for (Row& row : rows.first(used)) solve_push(row, pushes);
  }
  for (std::size_t v = 0; v < contacts.pushes.size(); ++v) {
    contacts.pushes[v] = pushes.own[v];
    if (vertices.bodies.empty() || vertices.body_of[v] == kNoRigidBody) continue;
    const std::uint32_t body = vertices.body_of[v];
    contacts.pushes[v] +=
        pushes.bodies[body].at(difference(vertices.positions[v], vertices.bodies[body].center));
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
  const std::span<std::uint32_t> stiff = arena.make<std::uint32_t>(vertices.bodies.empty() ? 0 : count);
  for (std::size_t v = 0; v < stiff.size(); ++v) {
    const std::uint32_t body = vertices.body_of[v];
    stiff[v] = body != kNoRigidBody && vertices.bodies[body].is_stiff ? body : kNoRigidBody;
  }
  BoundReport report;
  Array<SurfacePair> found;
  std::span<const SurfacePair> pairs = contacts.pairs;
  for (contacts.rounds = 1;; ++contacts.rounds) {
    const bool last = contacts.rounds > settings.most_rounds;
    for (std::size_t v = 0; v < count; ++v) moves[v] = asked[v];
    // The last round is for pairs that are found for any moves no longer than those that are asked for.
    report = bound_moves(pairs, vertices.positions, last ? contacts.limits.view() : std::span<const float>(),
                         held, stiff, settings.bounds, moves, arena, tasks);
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
    leave_out_stiff(vertices, found);
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
