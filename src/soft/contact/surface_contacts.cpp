#include "soft/contact/surface_contacts.h"

#include <cmath>

namespace gyre {

namespace {

// Vertices are looked for a little further than they move, so that impulses may change their moves.
constexpr float kLimitOfMove = 1.25f;
constexpr float kLimitOfRadius = 0.1f;
constexpr float kMaxLimitOfEdge = 1.0f;
constexpr float kNearOfThickness = 0.1f;  // pairs nearer than this have rows whatever their velocity
constexpr float kMaxPushOfThickness = 0.25f;

// The mean of the moves: surfaces that fly together do not look far.
DVec3 mean_of(std::span<const PlacedSurface> surfaces, std::span<const DVec3> moves) {
  DVec3 sum{};
  double count = 0.0;
  for (const PlacedSurface& placed : surfaces) {
    for (int v = 0; v < placed.surface->vertices; ++v) sum += moves[placed.first + std::size_t(v)];
    count += double(placed.surface->vertices);
  }
  return count > 0.0 ? sum / count : DVec3{};
}

// Limits and pads for these moves.
void set_reach(std::span<const PlacedSurface> surfaces, std::span<const float> inverse_mass,
               std::span<const DVec3> moves, std::span<float> limits, std::span<float> pads) {
  for (const PlacedSurface& placed : surfaces) {
    const float most = kMaxLimitOfEdge * placed.surface->mean_edge;
    for (int i = 0; i < placed.surface->vertices; ++i) {
      const std::size_t v = placed.first + std::size_t(i);
      const float radius = placed.surface->radius[i], far = float(length(moves[v]));
      limits[v] = inverse_mass[v] > 0.0f
                      ? min(kLimitOfMove * far + kLimitOfRadius * radius, max(most, radius))
                      : kLimitOfMove * far;
      pads[v] = limits[v] + radius;
    }
  }
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

struct Row {
  std::uint32_t pair;
  Vec3 normal;
  float mass;         // kg: impulse for a change of the relative velocity
  float target;       // m/s: least normal velocity
  float push_target;  // m: least normal displacement
  float push;         // kg m: so far
};

// Adds an impulse on a pair, times a factor for each vertex.
template <class Factor>
void add_to(std::span<Vec3> values, const SurfacePair& pair, Vec3 impulse, Factor&& factor) {
  for (int k = 0; k < 4; ++k) {
    const std::uint32_t v = pair.vertex[k];
    values[v] += pair.weight[k] * factor(v) * impulse;
  }
}
Vec3 sum_of(std::span<const Vec3> values, const SurfacePair& pair) {
  Vec3 out{};
  for (int k = 0; k < 4; ++k) out += pair.weight[k] * values[pair.vertex[k]];
  return out;
}

class RowSolver {
 public:
  // Of the pairs that may touch in this half step.
  RowSolver(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
            SurfaceContacts& contacts, Arena& arena)
      : vertices_(vertices), contacts_(contacts), rows_(arena.make<Row>(contacts.pairs.size())) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < std::uint32_t(contacts.pairs.size()); ++i) {
      if (may_touch(i, settings.step)) rows_[count++] = make_row(i, settings);
    }
    rows_ = rows_.first(count);
  }

  void solve(std::span<Vec3> velocities, int iterations) {
    const int count = int(rows_.size());
    for (int n = 0; n < iterations; ++n) {
      if (n % 2 == 0) {
        for (int i = 0; i < count; ++i) solve_row(rows_[i], velocities);
      } else {
        for (int i = count; i-- > 0;) solve_row(rows_[i], velocities);
      }
    }
  }

  void solve_pushes(std::span<Vec3> pushes, int iterations) {
    for (int n = 0; n < iterations; ++n) {
      for (Row& row : rows_) {
        if (!(row.push_target > 0.0f)) continue;
        const SurfacePair& pair = contacts_.pairs[row.pair];
        const float now = dot(row.normal, sum_of(pushes, pair));
        const float push = max(0.0f, row.push + (row.push_target - now) * row.mass);
        add(pushes, pair, (push - row.push) * row.normal);
        row.push = push;
      }
    }
  }

 private:
  bool may_touch(std::uint32_t i, float step) const {
    const SurfacePair& pair = contacts_.pairs[i];
    if (!pair.touches) return false;
    if (contacts_.impulses[i].normal > 0.0f) return true;
    const float gap = float(pair.distance - double(pair.thickness)), near = kNearOfThickness * pair.thickness;
    if (gap < near) return true;
    return gap - near < -kLimitOfMove * step * dot(to_float(pair.normal), sum_of(vertices_.velocities, pair));
  }
  Row make_row(std::uint32_t i, const SurfaceContactSettings& settings) {
    const SurfacePair& pair = contacts_.pairs[i];
    Row row;
    row.pair = i;
    row.normal = to_float(pair.normal);
    float mobility = 0.0f;
    for (int k = 0; k < 4; ++k) mobility += square(pair.weight[k]) * vertices_.inverse_mass[pair.vertex[k]];
    row.mass = mobility > 0.0f ? 1.0f / mobility : 0.0f;
    const float gap = float(pair.distance - double(pair.thickness));
    row.target = gap > 0.0f ? -gap / settings.step : 0.0f;
    row.push_target = gap < 0.0f ? min(-settings.pushout * gap, kMaxPushOfThickness * pair.thickness) : 0.0f;
    row.push = 0.0f;
    return row;
  }
  void add(std::span<Vec3> values, const SurfacePair& pair, Vec3 impulse) const {
    add_to(values, pair, impulse, [&](std::uint32_t v) { return vertices_.inverse_mass[v]; });
  }

  void solve_row(const Row& row, std::span<Vec3> velocities) {
    const SurfacePair& pair = contacts_.pairs[row.pair];
    SurfaceImpulse& impulse = contacts_.impulses[row.pair];
    const Vec3 velocity = sum_of(velocities, pair);
    const float along = dot(row.normal, velocity);
    const float normal = max(0.0f, impulse.normal - (along - row.target) * row.mass);
    if (normal == 0.0f && impulse.normal == 0.0f) return;
    // Inverse masses are scalars: normal and friction do not act on each other within a row.
    Vec3 friction = impulse.friction - row.mass * (velocity - along * row.normal);
    const float size = length(friction);
    if (size > pair.friction[0] * normal) friction = (pair.friction[1] * normal / size) * friction;
    add(velocities, pair, (normal - impulse.normal) * row.normal + (friction - impulse.friction));
    impulse.normal = normal;
    impulse.friction = friction;
  }

  const SurfaceVertices& vertices_;
  SurfaceContacts& contacts_;
  std::span<Row> rows_;
};

}  // namespace

void find_surface_contacts(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                           const SurfaceContactSettings& settings, Arena& arena, SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  const std::size_t count = vertices.positions.size();
  const std::span<DVec3> moves = arena.make<DVec3>(count);
  const std::span<float> pads = arena.make<float>(count);
  for (std::size_t v = 0; v < count; ++v) moves[v] = double(settings.step) * DVec3(vertices.velocities[v]);
  const DVec3 mean = mean_of(surfaces, moves);
  for (std::size_t v = 0; v < count; ++v) moves[v] = moves[v] - mean;
  contacts.limits.resize(count);
  set_reach(surfaces, vertices.inverse_mass, moves, contacts.limits, pads);
  const std::span<SurfacePair> before = arena.make<SurfacePair>(contacts.pairs.size());
  const std::span<SurfaceImpulse> impulses = arena.make<SurfaceImpulse>(contacts.impulses.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    before[i] = contacts.pairs[i];
    impulses[i] = contacts.impulses[i];
  }
  find_surface_pairs(surfaces, vertices.positions, pads, arena, contacts.pairs);
  keep_impulses(before, impulses, contacts.pairs, contacts.impulses);
}

void start_surface_contacts(const SurfaceVertices& vertices, SurfaceContacts& contacts) {
  contacts.given.assign(vertices.positions.size(), Vec3{});
  for (std::size_t i = 0; i < contacts.pairs.size(); ++i) {
    const SurfacePair& pair = contacts.pairs[i];
    SurfaceImpulse& impulse = contacts.impulses[i];
    if (!pair.touches) impulse = {};
    if (impulse.normal == 0.0f) continue;
    // The plane of friction turns with the normal.
    const Vec3 normal = to_float(pair.normal);
    impulse.friction -= dot(impulse.friction, normal) * normal;
    add_to(contacts.given, pair, impulse.normal * normal + impulse.friction,
           [&](std::uint32_t v) { return vertices.inverse_mass[v] > 0.0f ? 1.0f : 0.0f; });
  }
}

void solve_surface_contacts(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                            Arena& arena, SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  const std::size_t count = vertices.positions.size();
  const std::span<Vec3> velocities = arena.make<Vec3>(count);
  for (std::size_t v = 0; v < count; ++v) velocities[v] = vertices.velocities[v];
  RowSolver solver(vertices, settings, contacts, arena);
  solver.solve(velocities, settings.iterations);
  contacts.given.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    const float w = vertices.inverse_mass[v];
    contacts.given[v] = w > 0.0f ? (velocities[v] - vertices.velocities[v]) / w : Vec3{};
  }
  contacts.touching = 0;
  for (const SurfaceImpulse& impulse : contacts.impulses) contacts.touching += impulse.normal > 0.0f;
}

void push_surfaces(const SurfaceVertices& vertices, const SurfaceContactSettings& settings, Arena& arena,
                   SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  contacts.pushes.assign(vertices.positions.size(), Vec3{});
  RowSolver solver(vertices, settings, contacts, arena);
  solver.solve_pushes(contacts.pushes, settings.iterations);
}

BoundReport move_surfaces(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                          std::span<const DVec3> targets, const SurfaceContactSettings& settings,
                          Arena& arena, SurfaceContacts& contacts) {
  const ArenaScope scope(arena);
  const std::size_t count = vertices.positions.size();
  const std::span<DVec3> left = arena.make<DVec3>(count), moves = arena.make<DVec3>(count),
                         goals = arena.make<DVec3>(count);
  const std::span<std::uint8_t> held = arena.make<std::uint8_t>(count);
  const std::span<float> pads = arena.make<float>(count);
  for (std::size_t v = 0; v < count; ++v) {
    held[v] = !(vertices.inverse_mass[v] > 0.0f);
    goals[v] = held[v] != 0 ? targets[v] : targets[v] + contacts.pushes[v];
    left[v] = goals[v] - vertices.positions[v];
  }
  const DVec3 mean = mean_of(surfaces, left);
  for (std::size_t v = 0; v < count; ++v) left[v] = left[v] - mean;
  BoundReport report;
  Array<SurfacePair> found;
  std::span<const SurfacePair> pairs = contacts.pairs;
  bool again = true;
  for (contacts.rounds = 1; again; ++contacts.rounds) {
    for (std::size_t v = 0; v < count; ++v) moves[v] = left[v];
    const BoundReport one =
        bound_moves(pairs, vertices.positions, contacts.limits, held, settings.bounds, moves, arena);
    report = {one.shortened, report.forced + one.forced, contacts.rounds == 1 ? one.crossed : report.crossed};
    // Those that would go further than they were looked for go on in another round.
    again = false;
    for (std::size_t v = 0; v < count; ++v) {
      again |= held[v] == 0 && length(left[v]) > double(contacts.limits[v]);
      vertices.positions[v] += moves[v];
      left[v] = left[v] - moves[v];
    }
    again = again && contacts.rounds < settings.most_rounds;
    if (!again) break;
    set_reach(surfaces, vertices.inverse_mass, left, contacts.limits, pads);
    find_surface_pairs(surfaces, vertices.positions, pads, arena, found);
    pairs = found;
  }
  // All have moved by the mean less than they should.
  for (std::size_t v = 0; v < count; ++v) {
    const bool there = held[v] != 0 || left[v] == DVec3{};
    vertices.positions[v] = there ? goals[v] : vertices.positions[v] + mean;
  }
  return report;
}

}  // namespace gyre
